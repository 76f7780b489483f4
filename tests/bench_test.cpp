// flaunay-bench on tiny inputs: exit codes, what its records hold, and that its plots are what they should
// be.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "bench/plot.hpp"
#include "tests/support/paths.hpp"

namespace {

namespace fs = std::filesystem;
namespace plot = flaunay::bench::plot;

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// What is wrong with an XML text's tags, quotes or numbers; empty if nothing is.
std::string xml_fault(const std::string& text) {
  std::vector<std::string> open;
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return "a tag without an end";
    const std::string tag = text.substr(at + 1, end - at - 1);
    at = end;
    if (tag.empty() || tag[0] == '?') continue;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return "odd quotes in <" + tag + ">";
    if (tag.find('<') != std::string::npos) return "a tag in a tag: <" + tag + ">";
    const auto name_end = std::find_if(tag.begin() + 1, tag.end(),
                                       [](unsigned char c) { return !std::isalnum(c) && c != ':'; });
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "<" + tag + "> closes nothing";
      open.pop_back();
    } else if (tag.back() != '/') {
      open.emplace_back(tag.begin(), name_end);
    }
  }
  if (!open.empty()) return "<" + open.back() + "> is not closed";
  for (const char* number : {"\"nan", "\"-nan", "\"inf", "\"-inf", ",nan", ",inf"}) {
    if (text.find(number) != std::string::npos) return "a coordinate that is no number";
  }
  return text.find("<svg ") == std::string::npos ? "no <svg>" : "";
}

TEST(Xml, FaultsAreFound) {
  EXPECT_EQ(xml_fault("<svg a=\"1\"><g/></svg>"), "");
  EXPECT_NE(xml_fault("<svg a=\"1\"><g></svg>"), "");
  EXPECT_NE(xml_fault("<svg a=\"1><g/></svg>"), "");
  EXPECT_NE(xml_fault("<svg a=\"nan\"></svg>"), "");
}

class BenchTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "flaunay-bench-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  /// Runs flaunay-bench and returns its exit code; standard output and error are in files "out" and "err".
  int run(const std::string& arguments) const {
    const std::string command =
        flaunay::bench_executable() + " " + arguments + " >" + path("out") + " 2>" + path("err");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  /// Runs with a record and a plot, checks what all of them have, and returns the record.
  nlohmann::json run_well(const std::string& arguments) const {
    const std::string json = path("record.json"), svg = path("plot.svg");
    EXPECT_EQ(run(arguments + " --runs 1 --json " + json + " --plot " + svg), 0) << contents(path("err"));
    EXPECT_EQ(xml_fault(contents(svg)), "");
    const auto record = nlohmann::json::parse(contents(json), nullptr, false);
    EXPECT_TRUE(record.is_object());
    for (const char* key :
         {"device", "driver", "platform", "host", "commit", "command", "date", "runs", "results"}) {
      EXPECT_TRUE(record.contains(key)) << key;
    }
    EXPECT_EQ(record.value("runs", 0), 1);
    return record;
  }

  fs::path directory_;
};

void expect_keys(const nlohmann::json& row, const std::vector<std::string>& keys) {
  for (const std::string& key : keys) EXPECT_TRUE(row.contains(key)) << key << " in " << row;
}

void expect_times(const nlohmann::json& row) {
  const double low = row.value("seconds_min", 0.0), median = row.value("seconds_median", 0.0);
  EXPECT_GT(low, 0) << row;
  EXPECT_LE(low, median) << row;
  EXPECT_LE(median, row.value("seconds_max", 0.0)) << row;
}

TEST_F(BenchTest, Usage) {
  EXPECT_EQ(run("--help"), 0);
  EXPECT_EQ(run("peers --help"), 0);
  EXPECT_NE(contents(path("out")).find("cgal"), std::string::npos);
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("nothing"), 2);
  EXPECT_EQ(run("modes --modes nothing"), 2);
  EXPECT_EQ(run("peers --distributions nothing"), 2);
  EXPECT_EQ(run("primitives --sizes 0"), 2);
  EXPECT_EQ(run("scaling --least 8 --most 7"), 2);
  EXPECT_EQ(run("cliffs --distributions nothing"), 2);
  EXPECT_EQ(run("small --sizes 0"), 2);
  EXPECT_EQ(run("batches --points 0"), 2);
  EXPECT_EQ(run("embedding --sizes 0"), 2);
  EXPECT_EQ(run("threads --counts 0"), 2);
  EXPECT_EQ(run("targets --modes nothing"), 2);
  EXPECT_EQ(run("paper --smallest 9 --largest 8"), 2);
  EXPECT_EQ(run("paper --output " + path("err") + "/folder --smallest 6 --largest 6"), 3);
  EXPECT_EQ(run("modes --sizes 100 --json " + path("no/such/folder.json")), 3);
  EXPECT_EQ(run("primitives --sizes 100 --device no-such-device"), 4);
}

TEST_F(BenchTest, PeersAgreeAndAreRecorded) {
  const auto record = run_well("peers --sizes 300,900 --distributions uniform,grid");
  expect_keys(record, {"best", "skipped"});
  std::size_t of_flaunay = 0;
  for (const auto& row : record["results"]) {
    expect_keys(row, {"implementation", "distribution", "n", "bytes_peak", "triangles", "agrees"});
    expect_times(row);
    EXPECT_TRUE(row.value("agrees", false)) << row;
    of_flaunay += row.value("implementation", "").rfind("flaunay-", 0) == 0;
  }
  EXPECT_EQ(of_flaunay, 8u);  // two modes on four inputs
  EXPECT_EQ(record["best"].size(), 4u);
}

TEST_F(BenchTest, SlowPeersAreSkippedAndSaidSo) {
  const auto record =
      run_well("peers --sizes 200000 --distributions uniform --modes flattened --limit 0.001");
  EXPECT_EQ(record["results"].size(), 1u);
  for (const auto& row : record["skipped"]) {
    expect_keys(row, {"implementation", "distribution", "n"});
    EXPECT_NE(row.value("reason", "").find("took more than"), std::string::npos) << row;
  }
  if (!record["skipped"].empty()) {
    EXPECT_NE(contents(path("err")).find("not measured"), std::string::npos);
  }
}

// Qhull's tolerances drop points where they are dense among few far ones.
TEST_F(BenchTest, WrongCountsAreAFailure) {
  const int code =
      run("peers --sizes 100000 --distributions kuzmin --modes flattened --peers qhull --runs 1");
  const std::string messages = contents(path("err"));
  if (messages.find("without it") != std::string::npos) GTEST_SKIP() << "built without Qhull";
  EXPECT_EQ(code, 1);
  EXPECT_NE(messages.find("WARNING"), std::string::npos) << messages;
}

TEST_F(BenchTest, ModesAreRecorded) {
  const auto record = run_well("modes --sizes 256,512 --distributions uniform,line --modes flattened,dwyer");
  expect_keys(record, {"crossovers", "skipped"});
  EXPECT_EQ(record["results"].size() + record["skipped"].size(), 8u);
  EXPECT_FALSE(record["results"].empty());
  for (const auto& row : record["results"]) {
    expect_keys(row,
                {"mode", "distribution", "n", "kernel_launches", "host_waits", "bytes_peak", "undecided"});
    expect_times(row);
  }
}

TEST_F(BenchTest, SlowModesEnd) {
  const auto record = run_well("modes --sizes 256,512 --modes flattened --limit 0.0000001");
  EXPECT_EQ(record["results"].size(), 1u);
  ASSERT_EQ(record["skipped"].size(), 1u);
  EXPECT_EQ(record["skipped"][0].value("n", 0), 512);
  EXPECT_NE(contents(path("out")).find("not measured"), std::string::npos);
}

TEST_F(BenchTest, PrimitivesAreRecorded) {
  const auto record = run_well("primitives --sizes 1000");
  std::vector<std::string> names;
  for (const auto& row : record["results"]) {
    expect_keys(row, {"operation", "segmentation", "n", "bytes", "elements_per_second", "bytes_per_second"});
    expect_times(row);
    names.push_back(row.value("operation", ""));
  }
  for (const char* name :
       {"plain copy", "exclusive_scan uint8", "sort_by_key", "segmented_select", "permute"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

/// Rows of measured times; of how many implementations.
std::size_t expect_entries(const nlohmann::json& record) {
  std::set<std::string> implementations;
  EXPECT_TRUE(record.contains("skipped"));
  EXPECT_FALSE(record["results"].empty());
  for (const auto& row : record["results"]) {
    expect_keys(row, {"implementation", "distribution", "n", "triangles"});
    expect_times(row);
    EXPECT_TRUE(row.value("agrees", false)) << row;
    implementations.insert(row.value("implementation", ""));
  }
  return implementations.size();
}

bool without_cgal(const std::string& messages) {
  return messages.find("cgal: this build is without it") != std::string::npos;
}

TEST_F(BenchTest, TargetsAreMeasured) {
  const auto record = run_well("targets --quick --modes flattened");
  const bool cgal = !without_cgal(contents(path("err")));
  EXPECT_EQ(expect_entries(record), cgal ? 2u : 1u);
  std::map<std::string, int> of_goal;
  for (const auto& target : record["targets"]) {
    expect_keys(target, {"what", "implementation", "more_is_better", "at_least", "goal", "verdict"});
    const bool more = target.value("more_is_better", false);
    EXPECT_EQ(more, target.value("goal", 0.0) > target.value("at_least", 0.0));
    if (more && !cgal) continue;
    ASSERT_TRUE(target["measured"].is_number()) << target;
    const double measured = target["measured"], at_least = target["at_least"], goal = target["goal"];
    const auto keeps = [&](double limit) { return more ? measured >= limit : measured <= limit; };
    EXPECT_EQ(target.value("verdict", ""), keeps(goal) ? "goal" : keeps(at_least) ? "kept" : "MISSED");
    ++of_goal[target["goal"].dump()];
  }
  // Speedups, spreads, growth and degenerate inputs, sets, the call, memory.
  const std::map<std::string, int> expected = {{"1.15", 2}, {"1.1", 4}, {"0.7", 1}, {"1.0", 1}, {"140.0", 1}};
  EXPECT_EQ(of_goal["3.5"], cgal ? 8 : 0);
  for (const auto& [goal, count] : expected) EXPECT_EQ(of_goal[goal], count) << goal;
}

TEST_F(BenchTest, TargetsWithoutTheLargestInput) {
  const auto record = run_well("targets --quick --without-largest --modes dwyer");
  std::size_t unmeasured = 0;
  for (const auto& target : record["targets"]) {
    if (!target["measured"].is_null()) continue;
    ++unmeasured;
    EXPECT_EQ(target.value("verdict", ""), "not measured");
  }
  EXPECT_EQ(unmeasured, without_cgal(contents(path("err"))) ? 9u : 1u);
}

TEST_F(BenchTest, ScalingIsRecorded) {
  const auto record = run_well(
      "scaling --least 6 --most 8 --cgal-most 7 --distributions uniform,line --modes flattened,dwyer");
  const bool cgal = !without_cgal(contents(path("err")));
  EXPECT_EQ(expect_entries(record), cgal ? 3u : 2u);
  EXPECT_EQ(record["results"].size(), cgal ? 16u : 12u);
  EXPECT_EQ(record["skipped"].size(), cgal ? 2u : 0u);
}

TEST_F(BenchTest, CliffsAreBesideUniform) {
  const auto record = run_well("cliffs --sizes 300,900 --distributions grid,mostly-equal --modes flattened");
  const std::size_t implementations = expect_entries(record);
  EXPECT_EQ(record["cliffs"].size(), 2 * 2 * implementations);
  EXPECT_EQ(record["worst"].size(), implementations);
  double worst = 0;
  for (const auto& cliff : record["cliffs"]) {
    expect_keys(cliff, {"implementation", "distribution", "n", "times_uniform", "limit", "within"});
    if (cliff.value("implementation", "") == record["worst"][0].value("implementation", "")) {
      worst = std::max(worst, cliff.value("times_uniform", 0.0));
    }
  }
  EXPECT_EQ(record["worst"][0].value("times_uniform", -1.0), worst);
}

TEST_F(BenchTest, SlowInputsEnd) {
  const auto record =
      run_well("cliffs --sizes 300,900 --distributions grid --modes flattened --limit 0.0000001");
  std::size_t of_flaunay = 0;
  for (const auto& row : record["results"])
    of_flaunay += row.value("implementation", "") == "flaunay-flattened";
  EXPECT_EQ(of_flaunay, 2u);  // the smaller size of both inputs
}

TEST_F(BenchTest, SmallCallsAreRecorded) {
  const auto record = run_well("small --sizes 32,100 --modes flattened");
  const std::size_t implementations = expect_entries(record);
  EXPECT_EQ(record["results"].size(), 2 * implementations);
}

TEST_F(BenchTest, BatchesAreBesideLoops) {
  const auto record = run_well("batches --quick");
  const bool cgal = !without_cgal(contents(path("err")));
  EXPECT_EQ(expect_entries(record), cgal ? 3u : 2u);
  EXPECT_EQ(record["results"].size(), cgal ? 3u * 3 + 2 : 3u * 2 + 1);
  ASSERT_EQ(record["ratios"].size(), 3u);
  for (const auto& row : record["ratios"]) {
    expect_keys(row, {"implementation", "batch", "cgal_loop_over_one_call", "cgal_loop_over_its_one_set"});
    EXPECT_GT(row.value("sets", 0), 1);
    EXPECT_EQ(row.value("n", 0), 3000);
    EXPECT_EQ(row.value("loop_sets_measured", 0), row.value("sets", -1));
    EXPECT_EQ(row["cgal_loop_over_one_call"].is_number(), cgal);
    EXPECT_GT(row.value("own_loop_over_one_call", 0.0), 0);
    EXPECT_GT(row.value("one_call_over_one_set", 0.0), 0);
  }
  ASSERT_EQ(record["targets"].size(), 1u);
  EXPECT_EQ(record["targets"][0].value("goal", 0.0), 3);
}

// The numbers of triangles agree all the same.
TEST_F(BenchTest, LongLoopsAreScaled) {
  const auto record = run_well("batches --quick --loop-sets 7 --modes flattened");
  expect_entries(record);
  for (const auto& row : record["ratios"]) {
    EXPECT_LE(row.value("loop_sets_measured", 0), 7);
    EXPECT_GT(row.value("loop_sets_measured", 0), 0);
  }
  EXPECT_NE(contents(path("out")).find("scaled from"), std::string::npos);
}

TEST_F(BenchTest, EmbeddingIsMeasured) {
  const auto record = run_well("embedding --quick --far-walks 100");
  const bool cgal = !without_cgal(contents(path("err")));
  EXPECT_TRUE(record.value("agrees", false));
  std::map<std::string, int> of_operation;
  for (const auto& row : record["results"]) {
    expect_keys(row, {"operation", "implementation", "precision", "n", "count", "measured"});
    expect_times(row);
    ++of_operation[row.value("operation", "")];
    EXPECT_EQ(row.value("measured", 0),
              row.value("implementation", "") == "cgal: last face" ? 100 : row.value("n", 0))
        << row;
  }
  const int ways = cgal ? 4 : 1, voronoi = cgal ? 2 : 1, sizes = 2;
  const std::map<std::string, int> expected = {{"triangulate", sizes * 3 * 6}, {"locator", sizes},
                                               {"locate", sizes * ways},       {"nearest", sizes * ways},
                                               {"interpolate", sizes},         {"voronoi", sizes * voronoi}};
  EXPECT_EQ(of_operation, expected);
  ASSERT_EQ(record["ratios"].size(), 2u * 3 * 2);
  for (const auto& row : record["ratios"]) {
    expect_keys(row, {"parts", "precision", "n", "device_over_own_kernels", "device_over_host"});
    EXPECT_GT(row.value("device_over_host_kernels", 0.0), 0);
  }
  EXPECT_EQ(record["targets"].size(), 3u);
}

TEST_F(BenchTest, SecondEmbeddedCallsAllocateNothing) {
  const auto record = run_well("embedding --quick --far-walks 1");
  ASSERT_EQ(record["calls"].size(), 2u * 3 * 2);
  for (const auto& both : record["calls"]) {
    for (const char* call : {"first", "second"}) {
      expect_keys(both[call], {"host_waits", "kernel_launches", "bytes_to_host", "bytes_to_device"});
      EXPECT_GT(both[call].value("kernel_launches", 0), 0);
    }
    EXPECT_GT(both["first"].value("device_allocations", 0), 0);
    EXPECT_EQ(both["second"].value("device_allocations", -1), 0) << both;
  }
}

TEST_F(BenchTest, ThreadsHaveProcessesOfTheirOwn) {
  const auto record = run_well("threads --sizes 500,1000 --counts 1,2,3 --modes flattened,partition");
  expect_entries(record);
  EXPECT_EQ(record["results"].size(), 2u * 3 * 2);
  ASSERT_EQ(record["speedups"].size(), 2u * 2 * 2);
  for (const auto& row : record["results"]) EXPECT_GT(row.value("threads", 0), 0);
  for (const auto& speedup : record["speedups"]) {
    EXPECT_GT(speedup.value("speedup", 0.0), 0);
    EXPECT_NEAR(speedup.value("goal", 0.0), 0.9 * speedup.value("to_threads", 0), 1e-9);
  }
}

/// Rows of a CSV file by the names of its columns.
using Rows = std::vector<std::map<std::string, std::string>>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
  return result;
}

Rows read_csv(const std::string& path, const std::string& expected_header) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, expected_header) << path;
  const std::vector<std::string> names = cells(line);
  Rows rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> values = cells(line);
    EXPECT_EQ(values.size(), names.size()) << path << ": " << line;
    rows.emplace_back();
    for (std::size_t c = 0; c < std::min(names.size(), values.size()); ++c) rows.back()[names[c]] = values[c];
  }
  return rows;
}

std::uint64_t number(const std::map<std::string, std::string>& row, const std::string& column) {
  const auto found = row.find(column);
  return found == row.end() ? 0 : std::strtoull(found->second.c_str(), nullptr, 10);
}

std::string joined(const std::map<std::string, std::string>& row, const std::vector<std::string>& columns) {
  std::string result;
  for (const std::string& column : columns) result += row.at(column) + " ";
  return result;
}

class PaperTest : public BenchTest {
 protected:
  void SetUp() override {
    BenchTest::SetUp();
    ASSERT_EQ(run("paper --smallest 8 --largest 9 --instances 2 --threads 3 --output " + path("paper")), 0)
        << contents(path("err"));
  }
};

constexpr std::size_t kInputsOfASize = 4 * 2;  // distributions, instances

void expect_counts(const Rows& rows) {
  const std::vector<std::string> kinds = {"arithmetic", "depths", "orientations", "circles"};
  for (const auto& row : rows) {
    std::uint64_t counted = 0;
    for (const std::string& kind : kinds) counted += number(row, kind);
    EXPECT_GE(number(row, "operations"), counted) << joined(row, {"algorithm", "component", "level"});
    EXPECT_GE(number(row, "operations_with_bounds"), number(row, "operations"));
    EXPECT_GT(number(row, "operations") + number(row, "critical_path"), 0u);
  }
}

/// What precedes the first cut and all levels make the sum, for runs that are there level by level.
void expect_levels_add_up(const Rows& rows) {
  const std::vector<std::string> key = {"distribution", "n", "instance", "algorithm", "cut", "component"};
  std::map<std::string, std::uint64_t> all, of_levels;
  for (const auto& row : rows) {
    (row.at("level") == "all" ? all : of_levels)[joined(row, key)] += number(row, "operations");
  }
  EXPECT_EQ(of_levels.size(), kInputsOfASize * 2 * 5);  // cuts, components
  for (const auto& [name, operations] : of_levels) EXPECT_EQ(operations, all[name]) << name;
}

TEST_F(PaperTest, RunsAreWritten) {
  const Rows rows = read_csv(path("paper/paper-runs.csv"),
                             "distribution,n,instance,algorithm,cut,component,level,arithmetic,depths,"
                             "orientations,circles,operations,operations_with_bounds,critical_path");
  const auto totals =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.at("level") == "all"; });
  // Seven variants of the algorithm with five components, and Dwyer's with cuts and merges.
  EXPECT_EQ(static_cast<std::size_t>(totals), 2 * kInputsOfASize * (7 * 5 + 2));
  expect_counts(rows);
  expect_levels_add_up(rows);
}

TEST_F(PaperTest, LevelsAndEndGamesAreWritten) {
  const Rows levels = read_csv(path("paper/paper-levels.csv"),
                               "distribution,n,instance,algorithm,cut,level,regions,internal_points,corners,"
                               "largest_region,path_vertices,operations,operations_so_far,critical_path");
  EXPECT_EQ(
      std::count_if(levels.begin(), levels.end(), [](const auto& row) { return row.at("level") == "0"; }),
      static_cast<std::ptrdiff_t>(kInputsOfASize * 2));
  for (const auto& row : levels) {
    for (const char* column : {"regions", "internal_points", "corners", "largest_region", "path_vertices"}) {
      EXPECT_GT(number(row, column), 0u) << column;
    }
    EXPECT_LE(number(row, "internal_points"), 512u);
    EXPECT_GT(number(row, "operations_so_far"), number(row, "operations"));
  }
  const Rows endgames = read_csv(path("paper/paper-endgame.csv"), "distribution,n,cut,corners,regions");
  EXPECT_GE(endgames.size(), kInputsOfASize);
  for (const auto& row : endgames) {
    EXPECT_GE(number(row, "corners"), 3u);
    EXPECT_GT(number(row, "regions"), 0u);
  }
}

TEST_F(PaperTest, ReportHasClaimsAndFigures) {
  const std::string report = contents(path("paper/paper.md"));
  for (const char* part :
       {"within a factor of about 2 of Dwyer's", "work efficiency", "75 % dearer than uniform with quickhull",
        "25 % dearer than uniform with the balanced hull", "work / depth about 10^4", "fewer than 10 corners",
        "falls geometrically", "nearly free", "at most 1.0 times Dwyer's operations",
        "10 % above uniform in the hull", "## How this differs from the paper", "docs/counting.md",
        "`flaunay-bench paper --smallest 8 --largest 9"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(report.find("nan"), std::string::npos);
  std::size_t verdicts = 0;
  for (const std::string verdict : {"**agree**", "**partly**", "**disagree**"}) {
    for (std::size_t at = report.find(verdict); at != std::string::npos; at = report.find(verdict, at + 1)) {
      ++verdicts;
    }
  }
  EXPECT_EQ(verdicts, 10u);
  for (int figure = 6; figure <= 14; ++figure) {
    const std::string start = "](paper-figure-" + std::to_string(figure) + "-";
    const std::size_t at = report.find(start);
    ASSERT_NE(at, std::string::npos) << start;
    const std::string name = report.substr(at + 2, report.find(')', at) - at - 2);
    EXPECT_EQ(xml_fault(contents(path("paper/" + name))), "") << name;
  }
}

plot::Lines some_lines() {
  plot::Lines lines;
  lines.title = "a < b & c";
  lines.x = {"points", plot::Scale::log2};
  lines.y = {"time", plot::Scale::log10, plot::Unit::seconds};
  lines.series = {{"first", {1024, 4096, 16384, 65536}, {1e-3, 1e-2, 1e-1, 1}}};
  lines.references = {{"here", 2000}};
  return lines;
}

TEST(Plot, TicksOfLogarithmicAxes) {
  plot::Figure figure;
  figure.panels = {some_lines()};
  const std::string svg = plot::render(figure);
  EXPECT_EQ(xml_fault(svg), "");
  for (const char* label :
       {">1 ms<", ">10 ms<", ">100 ms<", ">1 s<", ">12<", ">first<", ">here<", "a &lt; b &amp; c"}) {
    EXPECT_NE(svg.find(label), std::string::npos) << label;
  }
}

TEST(Plot, WhatALogarithmCannotShowIsLeftOut) {
  plot::Lines lines = some_lines();
  lines.series[0].y = {0, std::nan(""), 1, -1};
  lines.series[0].low = {0, 0, 0, 0};
  lines.series[0].high = {1, 1, 2, 2};
  plot::Figure figure;
  figure.panels = {lines};
  EXPECT_EQ(xml_fault(plot::render(figure)), "");
}

TEST(Plot, BarsHaveTheirHeights) {
  plot::Bars bars;
  bars.y = {"operations", plot::Scale::linear};
  bars.parts = {"hull", "merge"};
  bars.comparison_name = "published";
  bars.groups = {{"uniform", {{"a", {30, 10}, {}, {}, 50}, {"b", {15, 5}}}}};
  bars.groups[0].bars.push_back({"c", {1234, 0}});
  bars.values = true;
  plot::Figure figure;
  figure.panels = {bars};
  const std::string svg = plot::render(figure);
  EXPECT_EQ(xml_fault(svg), "");
  for (const char* label : {">hull<", ">merge<", ">published<", ">40<", ">20<", ">1234<", ">uniform<"}) {
    EXPECT_NE(svg.find(label), std::string::npos) << label;
  }
}

TEST(Plot, NothingIsNoFault) {
  plot::Figure figure;
  EXPECT_EQ(xml_fault(plot::render(figure)), "");
  figure.panels = {plot::Lines{}, plot::Bars{}, plot::Scatter{}};
  EXPECT_EQ(xml_fault(plot::render(figure)), "");
}

}  // namespace
