#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/protocol/key_places.hpp"
#include "station/protocol/protocol.hpp"
#include "station/text/reader.hpp"

// Inside of the reader of protocol files: one function a part of the file. Each reads its tables into the
// protocol and reports what is wrong; those further down may rely on those further up having been called.
namespace turnpoint::protocol {

struct Reading {
  Protocol& protocol;
  text::Findings& findings;
  const KeyPlaces& places;
  std::vector<std::string> declared_scenes;  ///< all of the file, those with problems of their own too
};

void read_header(text::TableReader& file, Reading& reading);  ///< format, [protocol], [random]
void read_factors(text::TableReader& file, Reading& reading);
void read_scenes(text::TableReader& file, Reading& reading);
void read_instructions(text::TableReader& file, Reading& reading);
void read_task(text::TableReader& file, Reading& reading);
void read_timing(text::TableReader& file, Reading& reading);
void read_procedures(text::TableReader& file, Reading& reading);
void read_plan(text::TableReader& file, Reading& reading);
void read_analysis(text::TableReader& file, Reading& reading);
void read_resume(text::TableReader& file, Reading& reading);

/// What only shows once everything is read: values of factors in each trial, answers, passes, deadlines.
void check_whole(text::TableReader& file, Reading& reading);

/// A text in each declared language; a missing or undeclared language is a problem.
Localised read_localised(text::TableReader& reader, const std::string& key, const Reading& reading);
Localised localised_from(const text::Value& value, const std::string& key, const Reading& reading);

/// A number, or { uniform = [low, high] }.
std::optional<Distribution> read_distribution(text::TableReader& reader, const std::string& key);

/// A name made of letters, digits, _ and -; anything else is a problem.
std::string read_name(text::TableReader& reader, const std::string& key, const std::string& what);

/// The value of a factor as a file states it, checked against the factor's range or levels.
std::optional<FactorValue> read_factor_value(const text::Value& value, const Factor& factor,
                                             text::Findings& findings);

/// The factor that `key` names; a problem and nullptr where there is none, or where it is not numeric.
const Factor* read_numeric_factor(text::TableReader& reader, const std::string& key, const Reading& reading);

}  // namespace turnpoint::protocol
