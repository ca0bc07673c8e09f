#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"
#include "station/view/operator_code.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

mode_t mode_of(const std::string& path) {
  struct stat status {};
  REQUIRE(::stat(path.c_str(), &status) == 0);
  return status.st_mode & 0777;
}

std::string content(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::string& path, const std::string& text, mode_t mode) {
  std::ofstream(path) << text;
  REQUIRE(::chmod(path.c_str(), mode) == 0);
}

std::string problem_with(const std::string& file) {
  try {
    view::operator_code({file});
  } catch (const core::BadInput& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("only the right digits open, and the hash of a code does not reveal them", "[code]") {
  const auto code = view::OperatorCode::of_digits("7391");
  CHECK(code.opens("7391"));
  for (const auto* wrong : {"", "739", "73911", "7392", "2468", "1937"}) CHECK_FALSE(code.opens(wrong));
  CHECK(code.hash().substr(0, 3) == "$y$");  // the prefix of yescrypt
  CHECK(code.hash().find("7391") == std::string::npos);
  // hashes are salted, so the same code gives another hash
  CHECK(view::OperatorCode::of_digits("7391").hash() != code.hash());
  CHECK(view::OperatorCode::of_hash(code.hash()).opens("7391"));
}

TEST_CASE("other programs make the same hash of the same code", "[code]") {
  // This hash was made on Debian 12 by perl -e 'print crypt("7391", "\$y\$j9T\$abcdefghijklmnopqrstu.")';
  // crypt(5) describes the format.
  const auto known = view::OperatorCode::of_hash(
      "$y$j9T$abcdefghijklmnopqrstu.$Cc1pVTPQa0zlBFjGhM8JKmhg2p/63he89aBGE3QLOPC");
  CHECK(known.opens("7391"));
  CHECK_FALSE(known.opens("7392"));
}

TEST_CASE("codes that a keypad cannot type, short codes and the public code are refused", "[code]") {
  for (const auto* digits : {"", "739", "24b8", "7391 ", "1234567890123", "2468"})
    CHECK_THROWS_AS(view::OperatorCode::of_digits(digits), core::UsageError);
  CHECK_NOTHROW(view::OperatorCode::of_digits("123456789012"));
}

TEST_CASE("only its owner can read a stored code, and the first existing file is used", "[code]") {
  const TemporaryFolder folder;
  const auto own = folder / "config/turnpoint/operator-code", station = folder / "etc/operator-code";
  CHECK(view::operator_code({own, station}).is_built_in());
  CHECK(view::operator_code({own, station}).opens("2468"));

  view::store_operator_code(view::OperatorCode::of_digits("7391"), station);
  CHECK(mode_of(station) == 0600);
  CHECK(content(station).find("7391") == std::string::npos);
  CHECK(view::operator_code({own, station}).opens("7391"));
  CHECK_FALSE(view::operator_code({own, station}).opens("2468"));
  view::store_operator_code(view::OperatorCode::of_digits("8520"), own);
  CHECK(view::operator_code({own, station}).opens("8520"));
  CHECK_FALSE(view::operator_code({own, station}).opens("7391"));
}

TEST_CASE("a file that contains no code, or that everybody may read, is refused, and the message names it",
          "[code]") {
  const TemporaryFolder folder;
  const auto file = folder / "operator-code";
  for (const auto* text : {"7391\n", "\n", "$y$\n", "$9$abc$def\n"}) {
    write(file, text, 0600);
    CAPTURE(text);
    CHECK(problem_with(file) == file +
                                    ":1:1: this file does not contain an operator's code; store a code with "
                                    "`turnpoint operator-code`");
  }
  write(file, view::OperatorCode::of_digits("7391").hash() + "\n", 0640);
  CHECK(problem_with(file).empty());
  write(file, view::OperatorCode::of_digits("7391").hash() + "\n", 0644);
  CHECK(problem_with(file).find("every user of this computer may read") != std::string::npos);
}

TEST_CASE("after wrong codes the waiting time grows, and the right code resets it", "[code]") {
  view::CodeBackOff back_off;
  double now_s = 100;
  std::vector<double> waits_s;
  for (int i = 0; i < 10; ++i) {
    back_off.wrong(now_s);
    waits_s.push_back(back_off.wait_s(now_s));
    now_s += back_off.wait_s(now_s);
    CHECK(back_off.wait_s(now_s) == 0);
  }
  CHECK(waits_s == std::vector<double>{0, 0, 5, 10, 20, 40, 80, 160, 300, 300});
  back_off.wrong(now_s);
  CHECK(back_off.wait_s(now_s + 299) == 1);
  back_off.right();
  CHECK(back_off.wait_s(now_s) == 0);
  back_off.wrong(now_s);
  CHECK(back_off.wait_s(now_s) == 0);
}
