// flaunay-bench on tiny inputs: exit codes, what its records hold, and that bench/plot.py draws them.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

namespace {

namespace fs = std::filesystem;

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(contents(path)); }

class BenchTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "flaunay-bench-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override { fs::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  /// Runs a command and returns its exit code; standard output and error are in files "out" and "err".
  int run_command(const std::string& command) const {
    const int status = std::system((command + " >" + path("out") + " 2>" + path("err")).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int run(const std::string& arguments) const {
    return run_command(flaunay::bench_executable() + " " + arguments);
  }

  /// Runs and returns the record, after a check of what all of them have.
  nlohmann::json run_and_read(const std::string& arguments) const {
    const std::string json = path("record.json");
    EXPECT_EQ(run(arguments + " --json " + json), 0) << contents(path("err"));
    const auto record = json_of(json);
    EXPECT_TRUE(record.is_object());
    for (const char* key : {"subcommand", "device", "driver", "platform", "host", "commit", "command", "date",
                            "runs", "agree", "results"}) {
      EXPECT_TRUE(record.contains(key)) << key;
    }
    EXPECT_EQ(arguments.find(record.value("subcommand", "?")), 0u);
    EXPECT_TRUE(record.value("agree", false));
    return record;
  }
  nlohmann::json run_well(const std::string& arguments) const {
    const auto record = run_and_read(arguments + " --runs 1");
    EXPECT_EQ(record.value("runs", 0), 1);
    return record;
  }

  /// Whether this machine has what bench/plot.py needs.
  bool can_draw() const {
    const std::string err = contents(path("err")), out = contents(path("out"));
    const bool can = run_command(flaunay::plot_program() + " --help") == 0;
    std::ofstream(path("err")) << err;
    std::ofstream(path("out")) << out;
    return can;
  }

  /// That a file is XML and a picture, with all labels and with numbers for coordinates.
  void expect_picture(const std::string& svg, const std::vector<std::string>& labels) const {
    const std::string text = contents(svg);
    EXPECT_NE(text.find("<svg "), std::string::npos) << svg;
    for (const std::string& label : labels) {
      EXPECT_NE(text.find(">" + label + "<"), std::string::npos) << svg << ": " << label;
    }
    for (const char* number : {"\"nan", "\"inf", " nan", " inf"}) {
      EXPECT_EQ(text.find(number), std::string::npos) << svg;
    }
    EXPECT_EQ(run_command("python3 -c 'import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])' " + svg),
              0)
        << contents(path("err"));
  }

  /// That the last record can be drawn. The last expectation of a test, which is skipped where nothing can be
  /// drawn.
  void expect_drawn(const std::vector<std::string>& labels) const {
    if (!can_draw()) GTEST_SKIP() << "bench/plot.py cannot run here: no Matplotlib";
    const std::string svg = path("plot.svg");
    EXPECT_EQ(run_command(flaunay::plot_program() + " " + path("record.json") + " -o " + svg), 0)
        << contents(path("err"));
    expect_picture(svg, labels);
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
  for (const char* wrong :
       {"", "nothing", "modes --modes nothing", "peers --distributions nothing", "primitives --sizes 0",
        "scaling --peers nothing", "cliffs --distributions nothing", "batches --set-sizes 0",
        "embedding --sizes 0", "threads --counts 0", "targets --modes nothing", "launches --modes nothing",
        "device --steps 0", "paper --smallest 9 --largest 8"}) {
    EXPECT_EQ(run(wrong), 2) << wrong;
  }
  EXPECT_EQ(run("paper --smallest 6 --largest 6 --json " + path("no/such/folder.json")), 3);
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
  expect_drawn({"uniform", "grid", "flaunay-flattened", "time per point"});
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
    expect_keys(row, {"implementation", "distribution", "n", "kernel_launches", "host_waits", "undecided"});
    expect_times(row);
  }
  expect_drawn({"line", "flaunay-dwyer"});
}

TEST_F(BenchTest, SlowModesEnd) {
  const auto record = run_well("modes --sizes 256,512 --modes flattened --limit 0.0000001");
  EXPECT_EQ(record["results"].size(), 1u);
  ASSERT_EQ(record["skipped"].size(), 1u);
  EXPECT_EQ(record["skipped"][0].value("n", 0), 512);
  EXPECT_NE(contents(path("err")).find("not measured"), std::string::npos);
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
       {"plain copy", "exclusive_scan uint8", "sort_by_key", "count_flags", "segmented_arg_reduce"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
  expect_drawn({"1000 elements", "plain copy", "segments of 10"});
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
  const std::map<std::string, int> expected = {{"1.15", 2}, {"1.1", 3}, {"1.2", 1},
                                               {"0.7", 1},  {"1.0", 1}, {"140.0", 1}};
  EXPECT_EQ(of_goal["5.0"], cgal ? 9 : 0);
  for (const auto& [goal, count] : expected) EXPECT_EQ(of_goal[goal], count) << goal;
  expect_drawn({"goal", "grid / uniform, 2k"});
}

TEST_F(BenchTest, TargetsWithoutTheLargestInput) {
  const auto record = run_well("targets --quick --without-largest --modes dwyer");
  std::size_t unmeasured = 0;
  for (const auto& target : record["targets"]) {
    if (!target["measured"].is_null()) continue;
    ++unmeasured;
    EXPECT_EQ(target.value("verdict", ""), "not measured");
  }
  EXPECT_EQ(unmeasured, without_cgal(contents(path("err"))) ? 10u : 2u);
}

TEST_F(BenchTest, TargetsOfTheHostAreMeasuredOnOneCoreToo) {
  const auto record = run_well("targets --quick --without-largest --device host");
  const auto is_of_one_core = [](const auto& target) {
    return target.value("what", "").find("on one core") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(record["targets"].begin(), record["targets"].end(), is_of_one_core), 4);
}

TEST_F(BenchTest, ScalingIsRecorded) {
  const auto record = run_well(
      "scaling --sizes 64,128,256 --peers-most 128 --distributions uniform,line --modes flattened,dwyer");
  const bool cgal = !without_cgal(contents(path("err")));
  EXPECT_EQ(expect_entries(record), cgal ? 3u : 2u);
  EXPECT_EQ(record["results"].size(), cgal ? 16u : 12u);
  EXPECT_EQ(record["skipped"].size(), cgal ? 2u : 0u);
  expect_drawn({"Time per point by number of points", "points", "flaunay-dwyer"});
}

TEST_F(BenchTest, CliffsAreBesideUniform) {
  const auto record =
      run_well("cliffs --sizes 300,900 --distributions uniform,grid,mostly-equal --modes flattened");
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
  expect_drawn({"300 points", "mostly-equal", "times its own uniform time"});
}

TEST_F(BenchTest, SlowInputsEnd) {
  const auto record =
      run_well("cliffs --sizes 300,900 --distributions uniform,grid --modes flattened --limit 0.0000001");
  std::size_t of_flaunay = 0;
  for (const auto& row : record["results"])
    of_flaunay += row.value("implementation", "") == "flaunay-flattened";
  EXPECT_EQ(of_flaunay, 2u);  // the smaller size of both inputs
}

TEST_F(BenchTest, WholeProcessesAreTimed) {
  const auto record = run_well("processes --sizes 50 --options default,mode=dwyer");
  ASSERT_EQ(record["results"].size(), 2u);
  for (const auto& row : record["results"]) {
    expect_keys(row, {"option", "distribution", "n", "seconds_median", "seconds_min", "seconds_max"});
    EXPECT_GT(row.value("seconds_median", 0.0), 0);
  }
  EXPECT_EQ(record["results"][1].value("option", ""), "mode=dwyer");
  EXPECT_NE(run("processes --sizes 50 --program " + path("none")), 0);
}

TEST_F(BenchTest, ChunksAreTimed) {
  const auto record = run_well("processes --sizes 3000 --options default,memory=256M");
  ASSERT_EQ(record["results"].size(), 2u);
  EXPECT_FALSE(record["results"][0].contains("rounds"));
  EXPECT_EQ(record["results"][1].value("rounds", 0), 1);
  for (const auto& row : record["results"]) EXPECT_GT(row.value("resident_peak_mib", 0.0), 1);
}

TEST_F(BenchTest, RanksAreCounted) {
#ifndef FLAUNAY_BENCH_MPIRUN
  GTEST_SKIP() << "without MPI";
#else
  const auto record =
      run_well("ranks --sizes 3000 --sizes-per-rank 1000 --counts 1,3 --distributions uniform --launcher '" +
               std::string(FLAUNAY_BENCH_MPIRUN) + "'");
  ASSERT_EQ(record["results"].size(), 4u);
  for (const auto& row : record["results"]) {
    expect_keys(row, {"scaling", "distribution", "n", "ranks", "seconds_median", "processor_seconds_median",
                      "bytes_sent_over_own", "most_points_over_mean"});
    EXPECT_EQ(row.value("n", 0) == 3000 || row.value("ranks", 0) == 1, true);
    EXPECT_EQ(row.value("bytes_sent_over_own", 0.0) > 0, row.value("ranks", 0) == 3);
  }
  EXPECT_EQ(record["targets"].size(), 3u);
  expect_drawn({"Time by number of ranks", "strong: the same points"});
#endif
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
    EXPECT_EQ(row["cgal_loop_over_one_call"].is_number(), cgal);
    EXPECT_GT(row.value("own_loop_over_one_call", 0.0), 0);
    EXPECT_GT(row.value("one_call_over_one_set", 0.0), 0);
  }
  ASSERT_EQ(record["targets"].size(), 1u);
  EXPECT_EQ(record["targets"][0].value("goal", 0.0), 3);
  expect_drawn({"30 sets of 100", "time"});
}

TEST_F(BenchTest, SmallCallsAreLoops) {
  const auto record = run_well("batches --quick --points 500 --set-sizes 32,100 --modes flattened");
  std::set<std::string> loops;
  for (const auto& row : record["results"]) {
    EXPECT_GT(row.value("nanoseconds_per_point", 0.0), 0);
    if (row["implementation"] == "flaunay-flattened-loop") loops.insert(row.value("distribution", ""));
  }
  EXPECT_EQ(loops.count("15 sets of 32"), 1u);
  EXPECT_EQ(loops.count("5 sets of 100"), 1u);
}

TEST_F(BenchTest, EmbeddingIsMeasured) {
  const auto record = run_well("embedding --quick --far-walks 100");
  const bool cgal = !without_cgal(contents(path("err")));
  std::map<std::string, int> of_operation;
  for (const auto& row : record["results"]) {
    expect_keys(row, {"operation", "implementation", "precision", "n", "measured"});
    expect_times(row);
    ++of_operation[row.value("operation", "")];
    EXPECT_EQ(row.value("measured", 0),
              row.value("implementation", "") == "cgal: last face" ? 100 : row.value("n", 0))
        << row;
  }
  const int ways = cgal ? 4 : 1, voronoi = cgal ? 2 : 1, sizes = 2;
  const std::map<std::string, int> expected = {{"triangulate", sizes * 3 * 6}, {"locator", sizes},
                                               {"locate", sizes * ways},       {"nearest", sizes * ways},
                                               {"interpolate", sizes},         {"voronoi", sizes * voronoi},
                                               {"nearest in a fan", sizes}};
  EXPECT_EQ(of_operation, expected);
  EXPECT_EQ(record["targets"].size(), 3u);
  expect_drawn({"triangulate", "what is derived", "locate", "all, float32"});
}

TEST_F(BenchTest, LaterEmbeddedCallsAllocateNothing) {
  const auto record = run_well("embedding --quick --far-walks 1");
  std::size_t calls = 0;
  for (const auto& row : record["results"]) {
    if (row["operation"] != "triangulate" || row["implementation"] != "device") continue;
    expect_keys(row, {"parts", "precision", "host_waits", "bytes_to_host", "over_own_kernels", "over_host"});
    EXPECT_GT(row.value("kernel_launches", 0), 0);
    EXPECT_GT(row.value("over_host_kernels", 0.0), 0);
    EXPECT_EQ(row.value("device_allocations", -1), 0) << row;
    ++calls;
  }
  EXPECT_EQ(calls, 2u * 3 * 2);
}

TEST_F(BenchTest, DerivedIsBesideATriangulation) {
  const auto record = run_well("derived --sizes 3000 --columns 1,2 --iterations 2 --cgal");
  const bool cgal = record.contains("answers");
  EXPECT_EQ(record["results"].size(), 2u * 8 + 6 + (cgal ? 2 : 0));
  for (const auto& row : record["results"]) {
    expect_times(row);
    EXPECT_GT(row.value("of_triangulate", 0.0), 0) << row;
  }
  if (cgal) {
    EXPECT_LT(record["answers"][0].value("largest_difference", 1.0), 1e-9);
  }
}

TEST_F(BenchTest, OtherSurfacesAndWeightedPointsAreBesideCgal) {
  for (const std::string kind : {"sphere", "periodic", "weighted"}) {
    const auto record = run_well(kind + " --sizes 3000");
    EXPECT_GE(record["results"].size(), kind == "weighted" ? 8u : 7u);
    for (const auto& row : record["results"]) expect_times(row);
  }
}

TEST_F(BenchTest, ConstrainedIsBesideCgal) {
  const auto record = run_well("constrained --quick --polygon-points 10");
  ASSERT_EQ(record["results"].size(), 6u * 3);
  for (const auto& row : record["results"]) {
    EXPECT_EQ(row["agrees"], true) << row;
    EXPECT_EQ(row.value("of_constrained", 0.0) == 1, row["implementation"] == "flaunay-constrained") << row;
  }
  ASSERT_EQ(record["targets"].size(), 7u);
  EXPECT_EQ(record["results"][0]["segments"], 600);
}

TEST_F(BenchTest, RefinementIsBesideOthers) {
  const auto record = run_well("refinement --quick --device host");
  std::map<std::string, std::size_t> rows;
  for (const auto& row : record["results"]) {
    const std::string implementation = row["implementation"];
    ++rows[implementation];
    expect_times(row);
    EXPECT_GT(row.value("triangles", 0), 900) << row;
    // One corner of the hull of kuzmin has a smaller angle; Triangle puts a point there.
    EXPECT_LE(row.value("below_angle", 9), 2) << row;
    if (implementation != "flaunay") continue;
    EXPECT_GT(row.value("rounds_of_99_percent", 0), 0) << row;
    EXPECT_LE(row.value("rounds_of_99_percent", 0), row.value("rounds", 0)) << row;
  }
  EXPECT_EQ(rows["flaunay"], 7u);
  EXPECT_EQ(rows["flaunay, 1 thread"], 7u);
  // CGAL has the points at the first angle alone.
  if (rows.count("cgal") > 0) {
    EXPECT_EQ(rows["cgal"], 2u);
  }
}

TEST_F(BenchTest, TuningsAreBesideEachOther) {
  // Those of kuzmin fit into fixed point when they are rounded.
  const auto record = run_well(
      "modes --sizes 500 --distributions uniform,kuzmin --modes blocks --tunings "
      "fixed_point=0,fixed_point=1");
  EXPECT_EQ(expect_entries(record), 2u);
  EXPECT_EQ(record["results"].size(), 2u * 2);
  EXPECT_EQ(record["results"][0]["implementation"], "flaunay-blocks/fixed_point=0");
}

TEST_F(BenchTest, ThreadsHaveProcessesOfTheirOwn) {
  const auto record = run_well("threads --sizes 500,1000 --counts 1,2,3 --modes flattened,partition");
  expect_entries(record);
  EXPECT_EQ(record["results"].size(), 2u * 3 * 2);
  for (const auto& row : record["results"]) {
    if (row.value("threads", 0) == 1) continue;
    EXPECT_GT(row.value("speedup", 0.0), 0);
    EXPECT_NEAR(row.value("goal", 0.0), 0.9 * row.value("threads", 0), 1e-9);
  }
  expect_drawn({"uniform, threads: 3", "flaunay-partition"});
}

// ---- Launches and predictions

TEST_F(BenchTest, LaunchesAreThoseOfTheCall) {
  // Without rounds, so that blocks are merged, too.
  const auto record =
      run_well("launches --sizes 20000 --distributions uniform,line --tuning gpu,round_points=0");
  EXPECT_EQ(record.value("tuning", ""), "gpu,round_points=0");
  const std::set<std::string> merging{"merge_parts",  "finish_parts", "walk_seams",
                                      "finish_walks", "merge_trees",  "finish_trees"};
  ASSERT_EQ(record["results"].size(), 2u);
  for (const auto& row : record["results"]) {
    expect_keys(row, {"mode", "distribution", "n", "host_waits", "bytes_to_device", "bytes_to_host"});
    expect_times(row);
    int launches = 0;
    std::uint64_t chain = 0, longest = 0;
    std::map<std::string, std::uint64_t> steps;
    for (const auto& launch : record["launches"]) {
      if (launch["distribution"] != row["distribution"]) continue;
      EXPECT_EQ(launch.value("launch", -1), launches++);
      const std::string kernel = launch.value("kernel", "");
      steps[kernel] += launch.value("steps", std::uint64_t{0});
      if (merging.count(kernel) > 0) chain += launch.value("longest_chain", 0u);
      longest = std::max({longest, launch.value("longest_chain", std::uint64_t{0}),
                          launch.value("elements", std::uint64_t{0})});
    }
    EXPECT_EQ(launches, row.value("kernel_launches", 0));
    EXPECT_EQ(chain, row.value("merge_chain", 0u));
    EXPECT_GT(steps["walk_seams"], 0u);
    EXPECT_EQ(steps["finish_walks"], 0u);  // no predicate is undecided
    EXPECT_GT(row.value("merge_chain_above_blocks", 0u), 0u);
    EXPECT_LT(row.value("merge_chain_above_blocks", 0u), chain);
    EXPECT_EQ(longest, row.value("longest_chain", std::uint64_t{0}));
    EXPECT_GT(row.value("work_items_of_most_work", 0), 0);
  }
}

TEST_F(BenchTest, DevicesAreProbed) {
  const auto record = run_well(
      "device --steps 1000 --launches 5 --working-sets 4096,65536 --work-items 64 --copied-bytes 65536");
  EXPECT_GT(record.value("compute_units", 0), 0);
  std::map<std::string, double> medians;
  for (const auto& row : record["results"]) medians[row.value("what", "")] = row.value("median", 0.0);
  EXPECT_EQ(medians.size(), 9u);
  for (const auto& [what, median] : medians) EXPECT_GT(median, 0) << what;
  EXPECT_EQ(medians.count("load that waits for a load, of 64 KiB"), 1u);
}

class PredictionTest : public BenchTest {
 protected:
  std::string script(const std::string& name) const {
    return (fs::path(flaunay::plot_program()).parent_path() / "predictions" / name).string();
  }
  /// Predictions for one machine, of a record in `path`.
  nlohmann::json predicted(const std::string& record, const std::string& options) const {
    const std::string json = path("predicted.json");
    EXPECT_EQ(
        run_command("python3 " + script("predict.py") + " " + record + " --json " + json + " " + options), 0)
        << contents(path("err"));
    return json_of(json);
  }
  /// Launches of a kernel that the model does not know, or of "fill", as a record has them.
  static nlohmann::json launch_row(const char* kernel, std::size_t work_items, std::size_t elements,
                                   double bytes) {
    nlohmann::json row = kCall;
    row.update({{"kernel", kernel},
                {"work_items", work_items},
                {"group", 1},
                {"busy", 1},
                {"elements", elements},
                {"bytes", bytes},
                {"longest_chain", 0},
                {"steps", 0},
                {"seconds", 0.5}});
    return row;
  }
  /// Writes a record of one call.
  void write_record(const std::vector<nlohmann::json>& launches, int waits, double bytes_to_host) const {
    nlohmann::json summary = kCall;
    summary.update({{"kernel_launches", launches.size()},
                    {"host_waits", waits},
                    {"bytes_to_device", 0},
                    {"bytes_to_host", bytes_to_host},
                    {"seconds_median", 1.0}});
    std::ofstream(path("launches.json")) << nlohmann::json{
        {"subcommand", "launches"}, {"device", "none"}, {"results", {summary}}, {"launches", launches}};
  }
  /// The prediction for that call.
  nlohmann::json predicted_for(const std::string& machine) const {
    return predicted(path("launches.json"), "--machine " + machine)["results"][0];
  }

  static constexpr const char* kUnknown = "a kernel that nobody knows";
  static inline const nlohmann::json kCall = {{"mode", "blocks"}, {"distribution", "uniform"}, {"n", 1000}};
};

// By hand: launches of so many work-items that go through so many elements each.
TEST_F(PredictionTest, WorkItemsOfMostInstructions) {
  const auto of_last = [&](std::size_t elements) {
    write_record({launch_row(kUnknown, 10, elements, 0), launch_row(kUnknown, 1000, 10, 0),
                  launch_row(kUnknown, 100, 850, 0)},
                 0, 0);
    return predicted_for("h200").value("work_items_of_most_instructions", 0);
  };
  EXPECT_EQ(of_last(500), 100);
  EXPECT_EQ(of_last(2000), 10);
}

// By hand: what each launch takes by the model's definition and the machine's values.
TEST_F(PredictionTest, FollowTheModel) {
  write_record({launch_row("fill", 0, 0, 4.8e9), launch_row(kUnknown, 1, 1000000, 0)}, 3, 5e7);
  const auto h200 = predicted_for("h200"), cpu = predicted_for("cpu-64-cores");
  const auto seconds_of = [](const nlohmann::json& result, const std::string& kernel) {
    for (const auto& row : result["kernels"]) {
      if (row["kernel"] == kernel) return row["predicted_seconds"].get<double>();
    }
    return 0.0;
  };
  // 4.8 TB/s.
  EXPECT_NEAR(seconds_of(h200, "fill"), 1e-3, 1e-9);
  // 40 instructions at 0.3 cycles and a tenth of a misprediction of 15 cycles, at 4.5 GHz.
  EXPECT_NEAR(seconds_of(cpu, kUnknown), 1e6 * (40 * 0.3 + 0.1 * 15) / 4.5e9, 1e-9);
  // 38 instructions at 3 cycles and 2 of fp64 at 4.5, a load from L2 and one from memory.
  EXPECT_NEAR(seconds_of(h200, kUnknown), 1e6 * (38 * 3 + 2 * 4.5 + 263 + 479) / 1.98e9, 1e-6);
  const double on_device = h200["device_seconds"];
  EXPECT_NEAR(on_device, seconds_of(h200, "fill") + seconds_of(h200, kUnknown) + 3 * 2e-5, 1e-9);
  EXPECT_NEAR(h200["call_seconds"].get<double>() - on_device, 1e-3, 1e-9);
}

// A chain of 1,000 steps of walk_seams, whose fp64 takes long on consumers' GPUs, and as many as the whole
// device takes. Without a static table both texts have as many registers, so a compiler's version decides
// nothing.
TEST_F(PredictionTest, FixedPointNeedsNoFp64) {
  const auto times_of = [&](const char* tuning, std::size_t work_items, std::size_t steps) {
    nlohmann::json walks = launch_row("walk_seams", work_items, 1, 0);
    walks["longest_chain"] = steps / work_items;
    walks["steps"] = steps;
    write_record({walks}, 0, 0);
    nlohmann::json record = json_of(path("launches.json"));
    record["tuning"] = tuning;
    std::ofstream(path("launches.json")) << record;
    const auto of = [&](const char* machine) {
      const auto result = predicted(path("launches.json"), "--machine " + std::string(machine) +
                                                               " --static " + path("nothing"))["results"][0];
      EXPECT_EQ(result.value("fixed_point", false), std::string(tuning) == "gpu,fixed_point=1");
      return result["device_seconds"].get<double>();
    };
    return std::pair(of("rtx-4090"), of("h200"));
  };
  const auto chain = times_of("gpu", 1, 1000), in_fixed_point = times_of("gpu,fixed_point=1", 1, 1000);
  // Where fp64 has 1/64 of fp32's rate: a chain also waits for loads; the device is bound by fp64 alone.
  EXPECT_GT(chain.first, 1.1 * in_fixed_point.first);
  const auto many = times_of("gpu", 1000000, 100000000),
             many_fixed = times_of("gpu,fixed_point=1", 1000000, 100000000);
  EXPECT_GT(many.first, 2 * many_fixed.first);
  // Where it has 1/2: three quarters of a step are loads, the same in both texts, and its instructions differ
  // by a fifth.
  EXPECT_NEAR(chain.second / in_fixed_point.second, 1, 0.1);
  EXPECT_NEAR(many.second / many_fixed.second, 1, 0.1);
}

TEST_F(PredictionTest, OfEveryMachine) {
  run_well("launches --sizes 20000 --distributions uniform --tuning gpu");
  const std::string record = path("record.json");
  std::size_t machines = 0;
  for (const auto& file : fs::directory_iterator(script("machines"))) {
    const auto machine = json_of(file.path().string());
    for (const auto& [key, value] : machine.items()) {
      if (value.is_object()) {
        EXPECT_GT(value.value("source", "").size(), 5u) << file.path() << " " << key;
      }
    }
    const auto result = predicted(record, "--measured --machine " + file.path().stem().string());
    EXPECT_TRUE(result.value("predicted", false));
    ASSERT_EQ(result["results"].size(), 1u);
    double sum = 0;
    for (const auto& row : result["results"][0]["kernels"]) sum += row.value("predicted_seconds", 0.0);
    EXPECT_GT(sum, 0);
    EXPECT_GE(result["results"][0].value("call_seconds", 0.0), sum);
    const std::string text = contents(path("out"));
    EXPECT_NE(text.find("PREDICTED, not measured"), std::string::npos);
    EXPECT_NE(text.find("merge_parts"), std::string::npos);
    ++machines;
  }
  EXPECT_EQ(machines, 6u);
  // The machine file of the device, or of its type.
  EXPECT_EQ(predicted(record, "--for-device")["results"].size(), 1u);
  // One core takes longer than many.
  const auto one = predicted(record, "--machine cpu-64-cores --cores 1"),
             all = predicted(record, "--machine cpu-64-cores");
  EXPECT_GT(one["results"][0]["device_seconds"], all["results"][0]["device_seconds"]);
  EXPECT_EQ(run_command("python3 " + script("predict.py") + " " + record + " --machine nothing"), 2);
  EXPECT_EQ(run_command("python3 " + script("predict.py") + " " + path("nothing") + " --machine h200"), 2);
}

/// Versions of the compilers of a static table, by name. Each architecture has its compilers.
std::map<std::string, std::set<std::string>> compilers_of(const nlohmann::json& table) {
  std::map<std::string, std::set<std::string>> versions;
  std::set<std::string> compiled, named;
  for (const auto& row : table.at("results")) compiled.insert(row.value("architecture", ""));
  for (const auto& [architecture, compilers] : table.at("compilers").items()) {
    named.insert(architecture);
    EXPECT_EQ(compilers.count("ptxas"), std::size_t{architecture.rfind("sm_", 0) == 0}) << architecture;
    for (const auto& [name, version] : compilers.items()) versions[name].insert(version.get<std::string>());
  }
  EXPECT_EQ(compiled, named);
  return versions;
}

// The table that predictions take: figures of different compilers cannot be compared.
TEST_F(PredictionTest, StaticTableIsOfOneCompiler) {
  const fs::path results = fs::path(flaunay::plot_program()).parent_path() / "results";
  const auto compilers = compilers_of(json_of((results / "static.json").string()));
  EXPECT_EQ(compilers.size(), 2u);
  for (const auto& [name, versions] : compilers) EXPECT_EQ(versions.size(), 1u) << name;
}

TEST_F(PredictionTest, StaticTable) {
  const std::string json = path("static.json");
  const int code = run_command("python3 " + script("static.py") +
                               " operations/scan.cl --arch sm_80 --arch gfx90a --json " + json);
  const std::string messages = contents(path("err"));
  if (code != 0) {
    EXPECT_NE(messages.find("is skipped"), std::string::npos) << messages;
    EXPECT_NE(messages.find("install"), std::string::npos) << messages;
    GTEST_SKIP() << messages;
  }
  const auto record = json_of(json);
  EXPECT_EQ(compilers_of(record).count("clang"), 1u);
  std::map<std::string, std::set<std::string>> kernels;
  for (const auto& row : record["results"]) {
    EXPECT_GT(row.value("registers", 0), 0) << row;
    expect_keys(row, {"stack", "spills", "local_memory", "file_seconds"});
    kernels[row.value("architecture", "")].insert(row.value("kernel", ""));
  }
  for (const auto& [architecture, names] : kernels) {
    EXPECT_EQ(names.count("scan_reduce_uint"), 1u) << architecture;
    EXPECT_EQ(names.count("scan_write_uint8"), 1u) << architecture;
  }
  // Kernels of points have two texts.
  run_command("python3 " + script("static.py") + " points/inspect_tiles.cl --arch gfx90a --json " + json);
  std::multiset<bool> texts;
  const auto both = json_of(json);
  for (const auto& row : both["results"]) {
    if (row.value("kernel", "") == "inspect_tiles") texts.insert(row.value("fixed_point", false));
  }
  EXPECT_EQ(texts, (std::multiset<bool>{false, true}));
}

// ---- The paper

/// A list of a median, a minimum and a maximum.
void expect_spread(const nlohmann::json& row, const char* key) {
  ASSERT_TRUE(row.contains(key)) << key << " in " << row;
  EXPECT_LE(row[key][1].get<double>(), row[key][0].get<double>()) << key;
  EXPECT_LE(row[key][0].get<double>(), row[key][2].get<double>()) << key;
}

class PaperTest : public BenchTest {
 protected:
  void SetUp() override {
    BenchTest::SetUp();
    record_ = run_and_read("paper --smallest 8 --largest 9 --instances 2 --threads 3");
  }
  nlohmann::json record_;
};

TEST_F(PaperTest, CountsAreRecorded) {
  // Seven variants of the algorithm and Dwyer's on four distributions; three of them at the smaller size,
  // too.
  ASSERT_EQ(record_["results"].size(), (8u + 3) * 4);
  for (const auto& row : record_["results"]) {
    for (const char* key : {"operations_per_point", "over_dwyer", "depth", "parallelism"}) {
      expect_spread(row, key);
      EXPECT_GT(row[key][1].get<double>(), 0) << key;
    }
    if (row["algorithm"] == "dwyer") {
      EXPECT_EQ(row["over_dwyer"][0], 1);
    }
    if (row["n"] != 512) continue;
    double sum = 0;
    for (const char* key : {"sorting", "cuts", "hull", "merge", "split", "endgame"}) {
      expect_spread(row, key);
      sum += row[key][0].get<double>();
    }
    // Of two instances, medians add up like means.
    EXPECT_NEAR(sum, row["operations_per_point"][0].get<double>(), 1e-3 * sum);
  }
}

// What precedes the first cut and all levels make the sum.
TEST_F(PaperTest, LevelsAndEndGamesAreRecorded) {
  std::map<std::string, double> over_dwyer;
  const auto key_of = [](const nlohmann::json& row) {
    return row["distribution"].dump() + row["algorithm"].dump() + row["cut"].dump();
  };
  for (const auto& row : record_["levels"]) over_dwyer[key_of(row)] = row["work_before_over_dwyer"].back();
  EXPECT_EQ(over_dwyer.size(), 3u * 4);
  for (const auto& row : record_["results"]) {
    if (row["n"] != 512 || over_dwyer.count(key_of(row)) == 0) continue;
    EXPECT_NEAR(over_dwyer[key_of(row)], row["over_dwyer"][0].get<double>(), 1e-3);
  }
  EXPECT_EQ(record_["endgame"].size(), 2u * 4);
  for (const auto& row : record_["endgame"]) {
    EXPECT_GE(row["corners"][0], 3);
    EXPECT_EQ(row["corners"].size(), row["regions"].size());
  }
}

TEST_F(PaperTest, ReportHasClaimsAndFigures) {
  if (!can_draw()) GTEST_SKIP() << "no Matplotlib";
  ASSERT_EQ(run_command(flaunay::plot_program() + " " + path("record.json") + " -o " + path("paper.md")), 0)
      << contents(path("err"));
  const std::string report = contents(path("paper.md"));
  for (const char* part :
       {"within a factor of about 2 of Dwyer's", "work efficiency", "75 % dearer than uniform with quickhull",
        "25 % dearer than uniform with the balanced hull", "work / depth about 10^4", "fewer than 10 corners",
        "falls geometrically", "nearly free", "at most 1.0 times Dwyer's operations",
        "10 % above uniform in the hull", "## How this differs from the paper", "docs/counting.md",
        "`flaunay-bench paper --smallest 8 --largest 9"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(report.find("nan"), std::string::npos);
  const auto count = [&](const std::string& text) {
    std::size_t times = 0;
    for (std::size_t at = report.find(text); at != std::string::npos; at = report.find(text, at + 1)) ++times;
    return times;
  };
  EXPECT_EQ(count("**agree**") + count("**partly**") + count("**disagree**"), 10u);
  std::size_t figures = 0;
  for (std::size_t at = report.find("](paper-"); at != std::string::npos;
       at = report.find("](paper-", at + 1)) {
    expect_picture(path(report.substr(at + 2, report.find(')', at) - at - 2)), {});
    ++figures;
  }
  EXPECT_EQ(figures, 6u);
}

}  // namespace
