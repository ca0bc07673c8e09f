#include <zlib.h>

#include "station/store/backup.hpp"
#include "station/store/fields.hpp"
#include "station/store/merge.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

SignalRow stored_signal(const std::string& path, int trial_index) {
  auto database = sample::raw(path);
  Statement rows(database,
                 "SELECT " + column_list(signal_table()) + " FROM signal WHERE trial_index = ? LIMIT 1");
  rows.bind(trial_index);
  REQUIRE(rows.step());
  return record_of(rows, signal_table());
}

}  // namespace

TEST_CASE("a signal comes back as it was recorded, rounded to its resolution, with its gaps", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  const auto row = stored_signal(db, 1);
  CHECK(row.stream == "finger");
  CHECK(row.start_frame == 384000);
  CHECK(row.rate_Hz == 1000);
  REQUIRE(row.channels == sample::finger_signal(1).channels);
  const auto values = decode(row);
  REQUIRE(values.size() == 4);
  REQUIRE(values[0].size() == 500);
  for (std::size_t k = 0; k < 500; ++k) {
    CHECK(std::abs(values[0][k] - (0.5 + 0.1 * std::sin(0.02 * static_cast<double>(k) + 1))) <= 0.5001e-4);
    if (k < 20)
      CHECK(std::isnan(values[2][k]));
    else
      CHECK(std::abs(values[2][k] - (100 + 0.08 * static_cast<double>(k))) < 0.00501);
  }
}

TEST_CASE("a decoded value is the double nearest to a whole multiple of the resolution", "[store]") {
  SignalRow row;
  row.channels = {{"normal", "N", 1e-4}, {"half", "mm", 0.5}, {"odd", "mm", 0.03}};
  std::vector<double> thousandths;
  for (int k = -20000; k <= 20000; ++k) thousandths.push_back(1e-4 * k);
  encode(row, std::vector<std::vector<double>>(3, thousandths));
  const auto values = decode(row);
  for (int k = -20000; k <= 20000; ++k) {
    const auto at = static_cast<std::size_t>(k + 20000);
    REQUIRE(values[0][at] == k / 1e4);
    REQUIRE(std::abs(values[1][at] - thousandths[at]) <= 0.25);
    REQUIRE(std::abs(values[2][at] - thousandths[at]) <= 0.01500001);
  }
}

TEST_CASE("captured samples come back exactly, and lost ones as missing", "[store][raw]") {
  const auto values = decode(sample::raw_signal(0));
  REQUIRE(values.size() == 2);
  CHECK(values[0][0] == 0);
  CHECK(values[0][1] == -256);
  CHECK(std::isnan(values[0][2]));
  CHECK(values[1] == std::vector<double>{2147483647, -2147483647, 77});
  SignalRow row;
  row.channels = {{"channel_0", "", 1}, {"channel_1", "", 1}};
  const std::vector<std::int32_t> odd(3);
  CHECK_THROWS_AS(encode(row, std::span(odd)), std::logic_error);
}

TEST_CASE("a stored signal has the documented encoding", "[store]") {
  SignalRow row;
  row.stream = "finger";
  row.channels = {{"x", "mm", 0.5}, {"y", "N", 1}};
  encode(row,
         std::vector<std::vector<double>>{{1, 1.5, std::numeric_limits<double>::quiet_NaN()}, {-1, -1, 300}});
  CHECK(row.points == 3);
  // The whole numbers are 2, 3, -2^31 in the first channel and -1, -1, 300 in the second. Their differences
  // are 2, 1, 0x7FFFFFFD and 0xFFFFFFFF, 0, 301.
  const std::string shuffled{
      "\x02\x01\xFD\xFF\x00\x2D"
      "\x00\x00\xFF\xFF\x00\x01"
      "\x00\x00\xFF\xFF\x00\x00"
      "\x00\x00\x7F\xFF\x00\x00",
      24};
  std::string unpacked(24, '\0');
  uLongf size = unpacked.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(unpacked.data()), &size,
                     reinterpret_cast<const Bytef*>(row.data.bytes.data()), row.data.bytes.size()) == Z_OK);
  CHECK(size == 24);
  CHECK(unpacked == shuffled);
  CHECK(decode(row)[1] == std::vector<double>{-1, -1, 300});
}

TEST_CASE("a damaged signal is reported, and impossible values are refused", "[store]") {
  auto row = sample::finger_signal(0);
  SECTION("a changed byte") { row.data.bytes[row.data.bytes.size() / 2] ^= 0x10; }
  SECTION("missing bytes") { row.data.bytes.resize(row.data.bytes.size() - 5); }
  SECTION("more points than there are") { row.points = 501; }
  SECTION("fewer points than there are") { row.points = 499; }
  SECTION("an impossible number of points") { row.points = -1; }
  SECTION("another encoding") { row.encoding = "raw"; }
  const auto [kind, message] = sample::failure([&] { decode(row); });
  CHECK(kind == ErrorKind::corrupt);
  CHECK(sample::contains(message, "signal \"finger\""));
  SignalRow large;
  large.channels = {{"x", "mm", 1e-6}};
  CHECK_THROWS_AS(encode(large, std::vector<std::vector<double>>{{1e6}}), std::logic_error);
  CHECK_THROWS_AS(encode(large, std::vector<std::vector<double>>{{1}, {2}}), std::logic_error);
}

TEST_CASE("verify finds a changed signal and a removed signal", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  CHECK(verify(db).good());
  auto database = sample::raw(db);
  database.execute("DROP TRIGGER signal_is_never_changed; DROP TRIGGER signal_is_never_deleted");
  const auto* sql = GENERATE("UPDATE signal SET data = zeroblob(length(data)) WHERE trial_index = 1",
                             "UPDATE signal SET start_s = start_s + 0.001 WHERE trial_index = 1",
                             "DELETE FROM signal WHERE trial_index = 1");
  database.execute(sql);
  CHECK_FALSE(verify(db).good());
}

TEST_CASE("signals are merged and backed up with their trials, and withdrawn with their session", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  sample::session(db, 2);
  auto start = sample::start("P07");
  start.station_id = "bench-b";
  sample::session(other, 4, start);
  merge(db, other);
  CHECK(sample::raw(db).integer("SELECT count(*) FROM signal") == 6);
  const auto copy = backup(db, {folder / "copies", 30}).path;
  CHECK(sample::raw(copy).integer("SELECT count(*) FROM signal") == 6);
  CHECK(stored_signal(copy, 3).data == stored_signal(other, 3).data);
  CHECK(decode(stored_signal(db, 3))[0].size() == 500);
  CHECK(verify(db).good());
  REQUIRE(sample::contains(sample::bytes_of(db), stored_signal(other, 3).data.bytes));
  withdraw(db, {"P07", "", "", ""});
  CHECK(sample::raw(db).integer("SELECT count(*) FROM signal") == 2);
  CHECK(verify(db).good());
  CHECK_FALSE(sample::contains(sample::bytes_of(db), stored_signal(other, 3).data.bytes));
  merge(db, other);
  CHECK(sample::raw(db).integer("SELECT count(*) FROM signal") == 2);
}
