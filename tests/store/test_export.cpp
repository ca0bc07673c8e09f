#include "station/store/export.hpp"

#include <nlohmann/json.hpp>

#include "station/core/usage_error.hpp"
#include "station/store/read.hpp"
#include "station/store/text_table.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

std::vector<std::string> lines_of(const std::string& text, const std::string& end) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const auto next = text.find(end, at);
    REQUIRE(next != std::string::npos);
    lines.push_back(text.substr(at, next - at));
    at = next + end.size();
  }
  return lines;
}

const char* const kHeader =
    "participant_id,session_id,session_index,run_mode,protocol_id,protocol_version,protocol_sha256,block_"
    "index,"
    "block_name,instruction,practice,attempt,segment_id,trial_index,trial_type,procedure,onset,duration,"
    "level,"
    "level_unit,contrast,factor_instruction,boundary_mm,frequency_hz,amplitude,model,correct_response,"
    "response,"
    "correct,"
    "outcome,response_time,decision_time,movement_time,response_zero,response_time_quality,response_offset_s,"
    "deadline,xruns,extra_touches,threshold_est,threshold_sd,seed,station_id,calibration_id,software_version,"
    "response_zero_onset,trial_duration,proof,proof_cause,drive_ratio_db,drive_residual_db,onset_error_us,"
    "confidence,confidence_time,points,"
    "sensing,contact_s,strokes,normal_n,normal_sd_n,normal_in_window,speed_mm_s,speed_in_window,mu_low,"
    "mu_high,boundary_felt_mm,boundary_se_mm,lag_mm,tare_mn,mu,silence_db,silence_tone_db,"
    "followed,mu_asked,mu_commanded,mu_felt,follow_lag_ms,follow_inside,follow_share,envelope_error_db,"
    "envelope_lag_us,"
    "previous_level,previous_correct_response,previous_response,previous_correct,previous_outcome,"
    "again,previous_procedure,columns_version";

}  // namespace

TEST_CASE("trials.csv has all fixed columns in order, and the factors at their place", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 5);
  const auto files = export_data(db, folder / "out", {});
  REQUIRE(files.size() == 10);
  CHECK(files[0].path == folder / "out/two-boundaries/trials.csv");
  CHECK(files[0].rows == 5);
  CHECK(files[1].rows == 20);
  CHECK(files[2].rows == 10);
  CHECK(files[3].rows == 1);
  const auto lines = lines_of(sample::bytes_of(files[0].path), "\r\n");
  REQUIRE(lines.size() == 6);
  CHECK(lines[0] == kHeader);
  CHECK(
      lines[1] ==
      "P01," + id + ",1,simulated,two-boundaries,1.2.0," + std::string(64, 'a') +
          ",0,main,speed,0,0,1,0,experimental,staircase,n/a,n/a,-12.5,dB,0.30000000000000004,speed,150.25,"
          "30123.4567890123,2.5,mode,first,second,0,answered,0.4375,n/a,n/a,go_cue,simulated,0,2,0,0,-10,1.5,"
          "20240229,bench-a,"
          "n/a,0.1.0,2,3.5,flagged,level,-0.75,-55,12.5,1,0.75,2.5,ok,2.25,9,0.5,0.0625,0.875,"
          "80.5,0.6875,0.25,0.8125,150.5,0.375,0.625,-1.5,0.625,-57.5,-82.25,late "
          "lifted,0.5,0.5625,0.59375,1.75,0.875,0.9375,-32.5,"
          "62.5,n/a,n/a,n/a,n/a,n/a,6,n/a,2");
  CHECK(sample::contains(lines[5], ",mode,first,n/a,n/a,timeout,n/a,n/a,n/a,go_cue,n/a,"));
}

namespace {

/// Makes a session in which no two fields of a row have equal values, so that swapped columns are detected.
std::string session_of_unlike_values(const std::string& db) {
  auto start = sample::start("P07");
  start.run_mode = RunMode::pilot;
  start.observer = "";
  start.protocol_path = "study/two.toml";
  start.rig_path = "lab/plate.toml";
  start.calibration_id = std::string(64, 'c');
  start.calibration_text = "measured\n";
  start.language = "de";
  start.realtime_rights = "fifo 70";
  start.columns_version = "7";
  start.conditions = {45.5, 21.25, true, "right-index", 38};
  std::string id;
  {
    auto log = SessionLog::begin(db, start, sample::segment());
    EventRow tested{3'500'000'000, "self_test", "failed; continued: known", std::nullopt};
    tested.checks = {{"gate", Verdict::passed, 110.5, 250, "ms", "it shut"},
                     {"disk", Verdict::failed, 199, 200, "MiB", "nearly full"},
                     {"cells", Verdict::not_possible, {}, {}, "", "the rig has none"}};
    log.event(tested);
    EventRow measured{3'550'000'000, "friction_table", "used", std::nullopt};
    measured.friction_levels = {{0.5, 6, 0.71, 0.7, 0.03, 0.63, 0.78}, {1.5, 5, 0.2, 0.21, 0.01, 0.18, 0.24}};
    log.event(measured);
    EventRow asked{3'600'000'000, kAnswerEvent, "about-you.hand = left", std::nullopt};
    asked.answers = {{"about-you", "hand", 0, "left", 2.5}};
    log.event(asked);
    log.event({3'700'000'000, kBackEvent, place_name("about-you", 0), std::nullopt});
    asked = {3'800'000'000, kAnswerEvent, "about-you.hand = right", std::nullopt};
    asked.answers = {{"about-you", "hand", 0, "right", 1.25}};
    log.event(asked);
    log.begin_block({0, 0, "try", "accuracy", true});
    auto practice = sample::answered(0, 1);
    practice.type = TrialType::practice;
    practice.procedure = "";
    log.append(practice);
    log.begin_block({1, 2, "main", "speed", false});
    auto trial = sample::answered(1);
    trial.type = TrialType::catch_trial;
    trial.trial_in_block = 4;
    trial.presented.boundary_mm = 151.5;
    trial.timing.decision_time_s = 0.21;
    trial.timing.movement_time_s = 0.22;
    trial.timing.response_zero = "lift_off";
    trial.timing.response_time_quality = "kernel";
    trial.timing.response_offset_s = 0.011;
    trial.presented.xruns = 3;
    trial.given.extra_touches = 5;
    trial.tones[3].scene_index = 2;
    trial.tones[3].rove_dB = -1.25;
    trial.tones[3].reason = "said, \"so\"";
    trial.tones[3].friction.reset();
    log.presented(1, 4'000'000'001);
    log.event({4'100'000'002, "touch", "0.1 0.2", std::nullopt});
    // this event is logged only after the stimulus has ended, so its time is before that of the previous row
    log.event({4'050'000'000, "stimulus", "0.75", 1});
    log.append(trial);
    log.finish(SessionStatus::interrupted, "the participant left");
    id = log.session().session_id;
  }
  auto log = SessionLog::resume(
      db, id, {"boot-2", "resume", 9'000'000'000, 2'000'000'000, 1'709'197'300'000'000'000});
  log.begin_block({1, 2, "main", "speed", false});
  log.append(sample::timeout(2));
  log.annotate("first note");
  log.finish(SessionStatus::stopped, "long enough");
  return id;
}

}  // namespace

TEST_CASE("a line of trials.csv has the trial before it, in the same attempt and run of the program",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  std::string id;
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    log.begin_block(sample::block());
    auto first = sample::answered(0);
    first.level = -3, first.given.response = "first", first.given.correct = true;
    log.append(first);
    log.append(sample::timeout(1));
    log.append(sample::answered(2));
    log.begin_block(sample::block(0, 1));
    log.append(sample::answered(3));
    log.append(sample::answered(4));
    log.finish(SessionStatus::interrupted, "");
    id = log.session().session_id;
  }
  {
    auto log = SessionLog::resume(
        db, id, {"boot-2", "resume", 9'000'000'000, 2'000'000'000, 1'709'197'300'000'000'000});
    log.begin_block(sample::block(0, 1));
    log.append(sample::answered(5));
    log.append(sample::answered(6));
    log.finish(SessionStatus::completed, "");
  }
  const auto files = export_data(db, folder / "out", {});
  const auto lines = lines_of(sample::bytes_of(files[0].path), "\r\n");
  REQUIRE(lines.size() == 8);
  const std::string none = ",n/a,n/a,n/a,n/a,n/a,6,n/a,2";
  CHECK(lines[1].ends_with(none));
  CHECK(lines[2].ends_with(",-3,first,first,1,answered,6,staircase,2"));
  CHECK(lines[3].ends_with(",first,n/a,n/a,timeout,6,staircase,2"));
  CHECK(lines[4].ends_with(none));  // another attempt
  CHECK(lines[5].ends_with(",first,second,0,answered,6,staircase,2"));
  CHECK(lines[6].ends_with(none));  // after the session was resumed
  CHECK(lines[7].ends_with(",first,first,1,answered,6,staircase,2"));
}

TEST_CASE("each value of each table is in its own column", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = session_of_unlike_values(db);
  const auto files = export_data(db, folder / "out", {});
  for (const std::size_t i : {0, 1, 2, 3, 5, 6, 7}) {
    auto text = sample::bytes_of(files[i].path);
    for (auto at = text.find(id); at != std::string::npos; at = text.find(id))
      text.replace(at, id.size(), "ID");
    // Only this value depends on the session's random id.
    const auto checksum = list_sessions(db).front().checksum;
    if (const auto at = text.find(checksum); at != std::string::npos)
      text.replace(at, checksum.size(), "CHECKSUM");
    const auto name = std::filesystem::path(files[i].path).filename().string();
    INFO(name);
    CHECK(text == sample::bytes_of(TURNPOINT_SOURCE_DIR "/tests/store/golden/" + name));
  }
}

TEST_CASE("BIDS has the answers of each questionnaire as a phenotype", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  session_of_unlike_values(db);
  ExportOptions options;
  options.format = ExportFormat::bids;
  export_data(db, folder / "out", options);
  const auto phenotype = folder / "out/two-boundaries/phenotype/";
  CHECK(sample::bytes_of(phenotype + "about-you.tsv") ==
        "participant_id\tsession_id\toccasion\thand\nsub-P07\tses-01\t0\tright\n");
  const auto json = nlohmann::json::parse(sample::bytes_of(phenotype + "about-you.json"));
  CHECK(json.contains("hand"));
}

TEST_CASE("the codebook explains every column of every table", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  const auto files = export_data(db, folder / "out", {});
  const auto codebook = nlohmann::json::parse(sample::bytes_of(files[4].path));
  for (const std::size_t i : {0, 1, 2, 3, 5, 6, 7}) {
    const auto name = std::filesystem::path(files[i].path).filename().string();
    std::istringstream header(lines_of(sample::bytes_of(files[i].path), "\r\n")[0]);
    for (std::string column; std::getline(header, column, ',');) {
      INFO(name << " " << column);
      CHECK(codebook.at(name).at(column).at("Description").get<std::string>().size() > 3);
    }
  }
}

TEST_CASE("exports of the same data are identical, also through a new connection and during a session",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 7);
  sample::session(db, 3, sample::start("P02"));
  auto running = SessionLog::begin(db, sample::start("P03"), sample::segment());
  const auto format = GENERATE(ExportFormat::csv, ExportFormat::bids);
  ExportOptions options;
  options.format = format;
  const auto first = export_data(db, folder / "one", options);
  const auto second = export_data(db, folder / "two", options);
  REQUIRE(first.size() == second.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    CHECK(sample::bytes_of(first[i].path) == sample::bytes_of(second[i].path));
}

TEST_CASE("an export can select sessions, participants and protocols, and each protocol gets its own folder",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 3);
  sample::session(db, 2, sample::start("P02"));
  auto other = sample::start("P02");
  other.protocol_id = "../other design";
  other.factor_columns = {"mask"};
  sample::session(db, 4, other);
  const auto all = export_data(db, folder / "all", {});
  REQUIRE(all.size() == 20);
  CHECK(all[0].path == folder / "all/_.._other_design/trials.csv");
  CHECK(all[10].rows == 5);
  ExportOptions options;
  options.session_id = id;
  CHECK(export_data(db, folder / "one", options)[0].rows == 3);
  options = {};
  options.participant = "P02";
  options.protocol_id = "two-boundaries";
  CHECK(export_data(db, folder / "two", options)[0].rows == 2);
  options.participant = "P09";
  const auto [fault, message] = sample::failure([&] { export_data(db, folder / "none", options); });
  CHECK(fault == ErrorKind::missing);
  CHECK_FALSE(std::filesystem::exists(folder / "none"));
  // a name that differs only in what a folder cannot keep apart; FAT ignores case
  other.protocol_id = GENERATE("Two-boundaries", "two-BOUNDARIES");
  sample::session(db, 1, other);
  const auto [refusal, why] = sample::failure([&] { export_data(db, folder / "shared", {}); });
  CHECK(refusal == ErrorKind::conflict);
  CHECK(sample::contains(why, "export one at a time with --protocol"));
  CHECK_FALSE(std::filesystem::exists(folder / "shared"));
}

TEST_CASE("separator and decimal mark can be chosen, but must differ", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  ExportOptions options;
  options.separator = ';';
  options.decimal = ',';
  const auto files = export_data(db, folder / "out", options);
  const auto lines = lines_of(sample::bytes_of(files[0].path), "\r\n");
  CHECK(sample::contains(lines[1], ";-12,5;dB;0,30000000000000004;speed;150,25;30123,4567890123;"));
  options.separator = ',';
  CHECK_THROWS_AS(export_data(db, folder / "out", options), turnpoint::core::UsageError);
  options.decimal = 'x';
  CHECK_THROWS_AS(export_data(db, folder / "out", options), turnpoint::core::UsageError);
}

TEST_CASE("each CSV table begins with a byte order mark if that is asked for, and only CSV tables can",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  for (const char separator : {',', ';', '\t'}) {
    ExportOptions options;
    options.separator = separator;
    const auto style = std::to_string(separator);
    const auto plain = export_data(db, folder / ("plain" + style), options);
    options.byte_order_mark = true;
    const auto marked = export_data(db, folder / ("marked" + style), options);
    REQUIRE(plain.size() == marked.size());
    int tables = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      const auto without = sample::bytes_of(plain[i].path), with = sample::bytes_of(marked[i].path);
      if (plain[i].path.ends_with(".json")) {
        CHECK(with == without);
        continue;
      }
      ++tables;
      CHECK(with == "\xEF\xBB\xBF" + without);
      CHECK(read_table(with) == read_table(without));
    }
    CHECK(tables == 9);
    CHECK(verify(db, {"", folder / ("marked" + style) + "/two-boundaries/sessions.csv"}).good());
  }
  for (const auto format : {ExportFormat::bids, ExportFormat::signals}) {
    ExportOptions options;
    options.byte_order_mark = true, options.format = format;
    CHECK_THROWS_AS(export_data(db, folder / "other", options), turnpoint::core::UsageError);
  }
}

TEST_CASE("an export never replaces sessions that it does not have, unless they were withdrawn", "[store]") {
  TemporaryFolder folder;
  const auto one = folder / "one.sqlite", other = folder / "other.sqlite";
  sample::session(one, 2);
  const auto second = sample::session(one, 2, sample::start("P02"));
  sample::session(other, 3, sample::start("P03"));
  const auto trials = export_data(one, folder / "out", {})[0].path;
  const auto before = sample::bytes_of(trials);
  const auto [fault, message] = sample::failure([&] { export_data(other, folder / "out", {}); });
  CHECK(fault == ErrorKind::conflict);
  CHECK(sample::contains(message, "2 sessions that are not part of this export"));
  CHECK(sample::bytes_of(trials) == before);
  withdraw(one, {"P02", "", second, ""});
  export_data(one, folder / "out", {});
  CHECK_FALSE(sample::contains(sample::bytes_of(trials), second));
}

TEST_CASE("texts are quoted according to RFC 4180, and no text can act as a formula in a spreadsheet",
          "[store]") {
  TextTable table({}, {"a", "b"});
  table.row({cell("say \"no\""), cell("a, b")});
  table.row({cell("two\r\nlines"), cell("=HYPERLINK(\"x\")")});
  table.row({cell("+1"), cell(-1.5)});
  table.row({cell("@x"), cell("-x")});
  table.row({cell("-7.5"), cell("-7+8")});
  table.row({cell(""), Cell{}});
  CHECK(table.text() ==
        "a,b\r\n\"say \"\"no\"\"\",\"a, "
        "b\"\r\n\"two\r\nlines\",\"'=HYPERLINK(\"\"x\"\")\"\r\n'+1,-1.5\r\n'@x,'-x\r\n-7.5,'-7+8\r\n"
        "n/a,n/a\r\n");
  CHECK(table.rows() == 6);
  TextTable bids({TableStyle::Kind::bids, '\t', '.'}, {"a"});
  bids.row({cell("a\tb\nc")});
  CHECK(bids.text() == "a\na b c\n");
}
