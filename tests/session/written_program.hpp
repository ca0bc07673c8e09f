#pragma once
#include <filesystem>
#include <fstream>
#include <string>

#include "station/procedure/spec.hpp"
#include "tests/support/temporary_folder.hpp"

/// Writes an executable file and returns its path.
inline std::string written_program(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

/// A procedure in the language of the shell: the first level is -5, and each answer of 1 lowers it by 1, down
/// to -24. `before` is run before each message is handled; $n is the number of the message, from 1, and $line
/// its text. The working folder is that of the file.
inline std::string shell_procedure(const std::string& before = "", const std::string& version = "1") {
  return R"(#!/bin/sh
right=0 n=0
hello='{"type":"hello","format":"turnpoint-program/1","program":"shell","version":")" +
         version + R"("}'
while read -r line; do
  n=$((n + 1))
  )" + before +
         R"(
  case "$line" in
  *'"type":"hello"'*) echo "$hello" ;;
  *'"type":"answer"'*) case "$line" in *'"answer":1'*) right=$((right + 1)) ;; esac ;;
  *'"type":"next"'*)
    id=${line#*\"id\":} id=${id%%[,\}]*}
    echo "{\"id\":$id,\"type\":\"level\",\"level\":-$((5 + right % 20)),\"estimates\":{\"threshold\":{\"mean\":-$right,\"sd\":0.5,\"basis\":\"$right right\"}}}"
    ;;
  esac
done
)";
}

/// A specification for a program whose levels lie between -30 and -3.
inline turnpoint::procedure::Spec program_spec(const std::string& path, int trials, double limit_s = 30) {
  turnpoint::procedure::Spec spec;
  spec.name = "threshold";
  spec.kind = turnpoint::procedure::Kind::program;
  spec.level = "contrast_dB";
  spec.program.file = path;
  spec.program.limit_s = limit_s;
  spec.min = -30, spec.max = -3;
  spec.stop.trials = trials;
  return spec;
}
