// The command line as its users meet it: the built executable, its exit codes, messages and files.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "flaunay/research.hpp"
#include "tests/support/command.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/sanitized.hpp"

namespace {

using namespace flaunay::command;
namespace research = flaunay::research;

std::string npy(const std::string& type, const std::string& order, const std::string& shape,
                const std::string& data) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string file("\x93NUMPY\x01\x00", 8);
  file += static_cast<char>(header.size() % 256);
  file += static_cast<char>(header.size() / 256);
  return file + header + data;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The indices in an .npy file as the command writes it; its shape as NumPy prints it.
struct Array {
  std::string shape;
  std::vector<std::int32_t> values;
  bool is_wide = false;  ///< int64
};

template <typename Index>
std::vector<std::int32_t> indices_of(const std::string& bytes) {
  std::vector<Index> values(bytes.size() / sizeof(Index));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Index));
  return {values.begin(), values.end()};
}

Array read_array(const fs::path& path) {
  const std::string file = contents(path);
  Array array;
  if (file.size() < 10) return array;
  const std::size_t header_size =
      static_cast<unsigned char>(file[8]) + 256u * static_cast<unsigned char>(file[9]);
  const std::string header = file.substr(10, header_size);
  array.is_wide = header.find("'<i8'") != std::string::npos;
  EXPECT_TRUE(array.is_wide || header.find("'<i4'") != std::string::npos) << header;
  expect_parts(header, {"'fortran_order': False"});
  const std::size_t open = header.find('('), close = header.find(')');
  EXPECT_NE(close, std::string::npos) << header;
  array.shape = header.substr(open, close - open + 1);
  const std::string bytes = file.substr(10 + header_size);
  array.values = array.is_wide ? indices_of<std::int64_t>(bytes) : indices_of<std::int32_t>(bytes);
  return array;
}

nlohmann::json json_of(const fs::path& path) { return nlohmann::json::parse(contents(path)); }

Arguments joined(Arguments arguments, const Arguments& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

using Indices = std::vector<std::int32_t>;
using Rows = std::vector<std::array<std::int32_t, 3>>;

/// The rows of an m x 3 array, sorted: their order is each mode's own.
Rows sorted_rows(const fs::path& path) {
  const Array array = read_array(path);
  Rows rows;
  for (std::size_t i = 0; i + 3 <= array.values.size(); i += 3) {
    rows.push_back({array.values[i], array.values[i + 1], array.values[i + 2]});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

class ArraysTest : public CommandTest {
 protected:
  template <class T = std::int32_t>
  std::string write_rows(const std::string& name, const std::vector<T>& values,
                         std::size_t columns = 3) const {
    const std::string type = std::is_floating_point_v<T> ? "<f8" : sizeof(T) == 8 ? "<i8" : "<i4";
    const std::string shape =
        "(" + std::to_string(values.size() / columns) + ", " + std::to_string(columns) + ")";
    return write(name, npy(type, "False", shape, bytes_of(values)));
  }
};

// ---------------------------------------------------------------------------------------------------- usage

class CommandUsageTest : public ArraysTest {
 protected:
  /// The input is missing: that the option is what is complained of shows that it comes first.
  void refused(const std::string& option, const std::string& reason, const Arguments& arguments) const {
    expect_error(kUsage, {option, reason}, joined({"triangulate", path("missing.xyz")}, arguments));
  }
};

TEST_F(CommandUsageTest, VersionAndHelpSucceed) {
  EXPECT_EQ(run_well({"--version"}, kNoPlatform).out.rfind("flaunay ", 0), 0u);
  const std::string help = run_well({"--help"}, kNoPlatform).out;
  expect_parts(help, {"triangulate", "partition", "assemble", "generate", "verify", "devices"});
  EXPECT_NE(run_well({"triangulate", "--help"}, kNoPlatform).out.find("--neighbors"), std::string::npos);
}

TEST_F(CommandUsageTest, TypingErrorsAreAnsweredByWhatWasMeant) {
  const auto suggested = [this](const std::string& meant, const Arguments& arguments) {
    expect_error(kUsage, {"did you mean " + meant + ", not"}, arguments);
  };
  suggested("triangulate", {"triangluate", "points.npy"});
  suggested("--version", {"--verison"});
  suggested("--triangles", {"triangulate", "points.npy", "--triangels", "t.npy"});
  suggested("--neighbors", {"triangulate", "points.npy", "--neighbours=n.npy"});
  // What else is missing does not hide it.
  suggested("--resolution", {"terrain", "scan.las", "--resolutoin", "1", "-o", "dem.npy"});
  for (const Arguments& arguments :
       {Arguments{"frobnicate"}, Arguments{"triangulate", "points.npy", "--frobnicate"}}) {
    EXPECT_EQ(run(arguments, kNoPlatform).err.find("did you mean"), std::string::npos);
  }
  expect_error(kUsage, {"not understood: frobnicate points.npy --twice (see"},
               {"frobnicate", "points.npy", "--twice"});
}

TEST_F(CommandUsageTest, ExamplesOfTheHelpRun) {
  fs::copy(data("garden.las"), path("scan.las"));
  fs::create_directory(path("tiles"));
  fs::copy(data("garden.las"), path("tiles/scan.las"));
  for (const char* const name :
       {"generate", "triangulate", "verify", "partition", "assemble", "terrain", "devices"}) {
    std::istringstream help(run_well({name, "--help"}, kNoPlatform).out);
    std::string line;
    while (std::getline(help, line) && line != "Examples:") {
    }
    int count = 0;
    for (; std::getline(help, line) && line.starts_with("  flaunay "); ++count) {
      // Fewer points, and no device; GeoTIFF is not in every build.
      if (const std::size_t at = line.find("1000000"); at != line.npos) line.replace(at, 7, "1000");
      if (const std::size_t at = line.find("dem.tif"); at != line.npos) line.replace(at, 7, "dem.npy");
      if (line.find("--test") != line.npos) continue;
      const Outcome outcome =
          run_script("flaunay() { \"$FLAUNAY\" \"$@\"; }; " + line, {{"FLAUNAY_DEVICE", "host"}});
      EXPECT_EQ(outcome.exit_code, kSuccess) << line << "\n" << outcome.err;
    }
    EXPECT_GE(count, 1) << name;
  }
}

TEST_F(CommandUsageTest, CompletionForShellsAndTheManualPageNameAllOptions) {
  const std::string bash = run_well({"--print", "bash"}, kNoPlatform).out;
  write("flaunay.bash", bash);
  const auto completed = [this](const std::string& words) {
    const std::string script = "source flaunay.bash; COMP_WORDS=(flaunay " + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _flaunay; echo \"${COMPREPLY[@]}\"";
    return run_script("bash -c '" + script + "'").out;
  };
  EXPECT_EQ(completed("tri"), "triangulate\n");
  EXPECT_EQ(completed("triangulate points.npy --tri"), "--triangles --triangle-attributes\n");
  EXPECT_EQ(completed("triangulate points.npy --cut i"), "iqr\n");
  EXPECT_EQ(completed("generate kuzmin"), "\n");  // then the shell completes names of files

  const std::string zsh = run_well({"--print", "zsh"}, kNoPlatform).out;
  const std::string fish = run_well({"--print", "fish"}, kNoPlatform).out;
  const std::string manual = run_well({"--print", "man"}, kNoPlatform).out;
  for (const char* const name : {"triangulate", "verify", "terrain"}) {
    std::istringstream help(run_well({name, "--help"}, kNoPlatform).out);
    std::size_t count = 0;
    for (std::string line; std::getline(help, line);) {
      if (!line.starts_with("  --")) continue;
      ++count;
      const std::string option = line.substr(4, line.find(' ', 4) - 4);
      expect_parts(bash, {" --" + option});
      expect_parts(zsh, {" --" + option});
      expect_parts(fish, {std::string("from ") + name + "' -l " + option});
      std::string in_manual;
      for (const char c : "--" + option) in_manual += c == '-' ? std::string("\\-") : std::string(1, c);
      expect_parts(manual, {in_manual});
    }
    EXPECT_GE(count, 15U) << name;
  }
}

TEST_F(CommandUsageTest, TriangulateHelpListsTheModes) {
  const std::string help = run_well({"triangulate", "--help"}, kNoPlatform).out;
  for (const research::ModeInfo& info : research::list_modes()) {
    EXPECT_NE(help.find(info.description), std::string::npos) << info.name;
  }
}

TEST_F(CommandUsageTest, RequestsThatMakeNoSense) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n");
  expect_error(kUsage,
               {"subcommand", "triangulate", "partition", "assemble", "generate", "verify", "devices"}, {});
  expect_error(kUsage, {"frobnicate"}, {"frobnicate"});
  expect_error(kUsage, {"--frobnicate"}, {"triangulate", points, "--frobnicate"});
  expect_error(kUsage, {"input"}, {"triangulate"});
  expect_error(kUsage, {"--mode"}, {"triangulate", points, "--mode", "sideways"});
  expect_error(kUsage, {"--cut"}, {"triangulate", points, "--cut", "sideways"});
  expect_error(kUsage, {"empty"}, {"triangulate", points, "-o", ""});
  expect_error(kUsage, {"many"}, {"generate", "uniform", "many", "-o", path("many.npy")});
  expect_error(kUsage, {"-5"}, {"generate", "uniform", "-5", "-o", path("negative.npy")});
  expect_error(kBadInput, {"g.npy", "has room for"},
               {"generate", "uniform", "4000000000000000000", "-o", path("g.npy")});
  expect_error(kUsage, {"output"}, {"generate", "uniform", "10"});
  expect_error(kUsage, {"lumpy", "uniform", "kuzmin"}, {"generate", "lumpy", "10", "-o", path("points.npy")});
}

TEST_F(CommandUsageTest, OptionsThatTheModeWouldIgnoreAreRefused) {
  for (const research::ModeInfo& info : research::list_modes()) {
    const std::string mode = info.name;
    if (info.on_host) {
      refused("--device", mode, {"--mode", mode, "--device", "#0"});
      refused("--profile", mode, {"--mode", mode, "--profile"});
    }
    if (!info.cuts_regions) {
      refused("--hull-variant", mode, {"--mode", mode, "--hull-variant", "prune"});
      refused("--cut", mode, {"--mode", mode, "--cut", "iqr"});
    }
    if (!info.counts) refused("--count", mode, {"--mode", mode, "--count"});
    if (info.mode != research::Mode::recursive) {
      refused("--hull-variant", mode, {"--mode", mode, "--hull-variant", "monotone-chain"});
    }
    if (info.mode != research::Mode::flattened) {
      refused("--finish", "--mode flattened", {"--mode", mode, "--finish", "levels"});
    }
    if (info.mode != research::Mode::partition) {
      refused("--partition-levels", "--mode partition", {"--mode", mode, "--partition-levels", "2"});
      refused("--threads", "--mode partition", {"--mode", mode, "--threads", "2"});
    }
  }
  refused("--cut", "--mode flattened", {"--cut", "alternate"});
  refused("--count", "--mode flattened", {"--count"});
  refused("--finish", "--finish levels", {"--mode", "flattened", "--count", "--finish", "blocks"});
  refused("--threads", "0", {"--mode", "partition", "--threads", "0"});
  refused("--partition-levels", "0", {"--mode", "partition", "--partition-levels", "0"});
}

TEST_F(CommandUsageTest, OtherSurfacesRefuseWhatTheyDoNotHave) {
  for (const char* const option : {"--hull", "--halfedges", "--areas", "--constraints", "--mode"})
    refused(option, "--period",
            {"--period", "1,inf", option, std::string(option) == "--mode" ? "dwyer" : "x.npy"});
  refused("--profile", "--sphere", {"--sphere", "--profile"});
  refused("--memory", "--sphere", {"--sphere", "--memory", "1G"});
  refused("--points", "--sphere", {"--sphere", "--points", "p.npy"});
  refused("t.svg", "on the sphere", {"--sphere", "--output", "t.svg"});
  refused("--output", "in chunks", {"--period", "1,1", "--output", "t.obj", "--memory", "1G"});
  refused("--sphere", "--period", {"--sphere", "--period", "1,1"});
  refused("--offsets", "--period", {"--offsets", "o.npy"});
  refused("--device", "one device", {"--sphere", "--device", "all"});
  refused("--points", "in chunks", {"--period", "1,1", "--points", "p.npy", "--memory", "1G"});
  refused("--period", "1", {"--period", "1"});
  const std::string points = write("points.xy", "0 0\n1 0\n0 100\n");
  expect_error(kUsage, {"the period 0 x 1"}, {"triangulate", points, "--period", "0,1"});
  expect_error(kUsage, {"no shear"}, {"triangulate", points, "--period", "1,inf,1"});
  expect_error(kUsage, {"or one of them infinite"}, {"triangulate", points, "--period", "inf,inf"});
  expect_error(kBadInput, {"points.xy", "point 2", "latitude 100"}, {"triangulate", points, "--sphere"});
}

TEST_F(CommandUsageTest, WeightedPointsRefuseWhatTheyDoNotHave) {
  refused("--constraints", "--weighted", {"--weighted", "--constraints", "s.npy"});
  refused("--mode", "--weighted", {"--weighted", "--mode", "dwyer"});
  refused("--hidden", "--weighted", {"--hidden", "h.npy"});
  refused("--weighted", "--sphere", {"--weighted", "--sphere"});
  refused("--device", "one device", {"--weighted", "--device", "all"});
  expect_error(kBadInput, {"two.txt", "three numbers"},
               {"triangulate", write("two.txt", "1 2\n"), "--weighted"});
  expect_error(kBadInput, {"huge.txt: point 1", "too large"},
               {"triangulate", write("huge.txt", "0 0 0\n1 0 1e300\n0 1 0\n"), "--weighted"});
}

TEST_F(CommandUsageTest, UnknownEndings) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n");
  expect_error(kUsage, {"points.dwg", ".npy"}, {"triangulate", write("points.dwg", "0 0\n")});
  expect_error(kUsage, {"mesh.dwg", ".off"}, {"triangulate", points, "-o", path("mesh.dwg")});
  expect_error(kUsage, {"mesh", ".off"}, {"triangulate", points, "-o", path("mesh")});
  expect_error(kUsage, {"triangles.txt", ".npy"},
               {"triangulate", points, "--triangles", path("triangles.txt")});
  expect_error(kUsage, {"stats.txt", ".json"}, {"triangulate", points, "--stats", path("stats.txt")});
  expect_error(kUsage, {"points.dwg", ".npy"}, {"generate", "uniform", "10", "-o", path("points.dwg")});
}

TEST_F(CommandUsageTest, OutputsDoNotOverwriteTheInputOrEachOther) {
  const std::string points = write("points.node", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
  expect_error(kUsage, {"points.node", "overwrite the input"},
               {"triangulate", points, "-o", path("points.ele")});
  EXPECT_EQ(contents(points), "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
  const std::string array = write_rows<double>("points.npy", {1, 2}, 2);
  expect_error(kUsage, {"points.npy", "overwrite the input"}, {"triangulate", array, "--hull", array});
  expect_error(kUsage, {"same path"},
               {"triangulate", points, "--hull", path("a.npy"), "--triangles", path("./a.npy")});
}

TEST_F(CommandUsageTest, WhatIsForAClosedStreamGoesIntoNoFile) {
  write("points.xy", "0 0\n1 0\n0 1\n");
  run_script("\"$FLAUNAY\" triangulate points.xy --mode dwyer -o expected.off");
  const std::string expected = contents(path("expected.off"));
  for (const char* closed : {"<&- >&-", ">&-", "<&- >&- 2>&-"}) {
    SCOPED_TRACE(closed);
    const std::string command =
        "\"$FLAUNAY\" triangulate points.xy --mode dwyer -o mesh.off " + std::string(closed);
    EXPECT_EQ(run_script(command).exit_code, kSuccess);
    EXPECT_EQ(contents(path("mesh.off")), expected);
  }
  // Nothing is lost silently.
  const Outcome points = run_script("\"$FLAUNAY\" generate uniform 10 -o - >&-");
  EXPECT_EQ(points.exit_code, kBadInput);
  EXPECT_EQ(points.err, "flaunay: -: cannot be written: Bad file descriptor\n");
  EXPECT_EQ(run_script("\"$FLAUNAY\" triangulate - <&-").exit_code, kBadInput);
}

TEST_F(CommandUsageTest, MessagesEscapeWhatATerminalWouldObey) {
  const std::string name = "a\nb\x1b[31m", shown = "a\\nb\\x1b[31m";
  expect_error(kBadInput, {shown + ".xy", "No such file"}, {"triangulate", path(name + ".xy")});
  expect_error(kUsage, {shown}, {"triangulate", "points.xy", "--" + name});
  expect_error(kUsage, {shown}, {"generate", name, "10", "-o", path("points.npy")});
  const std::string points = write("points.xy", "0 0\n4 0\n0 4\n");
  const Outcome wrong =
      run({"verify", points, write(name + ".obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\n")}, kNoPlatform);
  EXPECT_EQ(wrong.exit_code, kFailure);
  expect_parts(wrong.err, {shown + ".obj: "});
  EXPECT_EQ(wrong.err.find('\n') + 1, wrong.err.size()) << wrong.err;
}

// ------------------------------------------------------------------------------------------------ bad input

using CommandBadInputTest = ArraysTest;

TEST_F(CommandBadInputTest, TheFileAndThePlaceAreNamed) {
  const auto mesh_of = [this](const std::string& file) {
    return Arguments{"triangulate", file, "-o", path("mesh.off")};
  };
  for (const std::string ending : {".npy", ".node", ".xy", ".txt", ".csv", ".bin", ".las"}) {
    expect_error(kBadInput, {"missing" + ending, "No such file"}, mesh_of(path("missing" + ending)));
    expect_error(kBadInput, {"empty" + ending}, mesh_of(write("empty" + ending, "")));
  }
  fs::create_directory(path("directory.xy"));
  expect_error(kBadInput, {"directory.xy"}, mesh_of(path("directory.xy")));
  expect_error(kBadInput, {}, mesh_of("-"));
  expect_error(kBadInput, {"points.xy", "line 4", "column 5"},
               mesh_of(write("points.xy", "# a comment\n0 0\n1 0\n0.5 oops\n")));
  expect_error(kBadInput, {"line 2", "column 3"}, mesh_of("-"), kNoPlatform, "0 0\n1 zero\n");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error(kBadInput, {"nan.npy", "point 2"},
               mesh_of(write_rows<double>("nan.npy", {0, 0, 1, 0, 2, nan}, 2)));
  expect_error(kBadInput, {"flat.npy"}, mesh_of(write_rows<double>("flat.npy", {0, 0, 1, 0}, 4)));
}

TEST_F(CommandBadInputTest, OutputThatCannotBeWrittenIsFoundBeforeTheWork) {
  // The input is missing and there is no device: that the output is what is complained of shows the order.
  const std::string input = path("missing.xy");
  const std::string nowhere = path("no/such/directory/");
  for (const char* option : {"--triangles", "--neighbors", "--hull", "--duplicates"}) {
    expect_error(kBadInput, {"no/such/directory/a.npy"}, {"triangulate", input, option, nowhere + "a.npy"});
  }
  for (const char* ending : {".ele", ".off", ".ply", ".msh", ".vtu", ".obj", ".npy", ".svg"}) {
    expect_error(kBadInput, {"no/such/directory/a"}, {"triangulate", input, "-o", nowhere + "a" + ending});
  }
  expect_error(kBadInput, {"a.json"}, {"triangulate", input, "--stats", nowhere + "a.json"});
  expect_error(kBadInput, {"a.npy"}, {"generate", "uniform", "10", "-o", nowhere + "a.npy"});
  fs::create_directory(path("directory.off"));
  expect_error(kBadInput, {"directory.off"}, {"triangulate", input, "-o", path("directory.off")});
}

TEST_F(CommandBadInputTest, AnOutputThatWasThereSurvivesAnError) {
  const std::string mesh = write("mesh.off", "precious");
  expect_error(kBadInput, {"missing.xy"}, {"triangulate", path("missing.xy"), "-o", mesh});
  EXPECT_EQ(contents(mesh), "precious");
}

// -------------------------------------------------------------------------------------- generate and verify

class CommandVerifyTest : public ArraysTest {
 protected:
  /// Expects the verdict that triangles are wrong, with these parts in the message.
  void expect_wrong(const std::vector<std::string>& parts, const Arguments& arguments) const {
    const Outcome outcome = run(joined({"verify"}, arguments), kNoPlatform);
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_EQ(outcome.out.rfind("wrong: ", 0), 0u) << outcome.out;
    EXPECT_EQ(outcome.err.rfind("flaunay: ", 0), 0u) << outcome.err;
    expect_parts(outcome.err, parts);
  }
  Outcome expect_right(const Arguments& arguments) const {
    const Outcome outcome = run_well(joined({"verify"}, arguments), kNoPlatform);
    EXPECT_EQ(outcome.out.rfind("right: ", 0), 0u) << outcome.out;
    return outcome;
  }
};

TEST_F(CommandVerifyTest, RightAndWrong) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 3\n0 4\n"),
                    vertices = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 4 0\n";
  expect_parts(expect_right({points, write("right.obj", vertices + "f 1 2 3\nf 1 3 4\n")}).out,
               {"2 triangles"});
  expect_wrong({"wrong.obj"}, {points, write("wrong.obj", vertices + "f 1 2 4\nf 2 3 4\n")});
  const std::string triangles = write_rows("t.npy", {0, 1, 2, 0, 2, 3});
  expect_right({points, triangles, "--neighbors", write_rows("right.npy", {-1, 1, -1, -1, -1, 0})});
  expect_wrong({}, {points, triangles, "--neighbors", write_rows("wrong.npy", {1, -1, -1, -1, -1, 0})});
  expect_wrong({}, {points, triangles, "--neighbors", write_rows("few.npy", {-1, 1, -1})});
  expect_wrong({}, {points, write_rows("range.npy", {0, 1, 4})});
  expect_error(kBadInput, {"missing.npy"}, {"verify", points, path("missing.npy")});
  expect_error(kBadInput, {"missing.npy"}, {"verify", path("missing.npy"), path("missing.npy")});
  expect_error(kBadInput, {"double.npy"}, {"verify", points, write_rows<double>("double.npy", {0, 1, 2})});
}

TEST_F(CommandVerifyTest, Constraints) {
  // Both diagonals of the square are Delaunay. Without segments that from the smallest point is canonical.
  const std::string points = write("points.xy", "0 0\n4 0\n4 4\n0 4\n");
  const std::string from_first = write_rows("first.npy", {0, 1, 2, 0, 2, 3}),
                    other = write_rows("other.npy", {0, 1, 3, 1, 2, 3});
  const std::string segments = write_rows<std::int64_t>("s.npy", {3, 1}, 2), text = write("s.txt", "3 1\n");
  for (const std::string& file : {segments, text}) {
    expect_parts(expect_right({points, other, "--constraints", file}).out, {"; 1 constraint edges"});
    expect_wrong({"segment 0 from point 3 at (0, 4) to point 1 at (4, 0) is no chain of edges"},
                 {points, from_first, "--constraints", file});
  }
  const std::string edges = write_rows("e.npy", {3, 1}, 2), turned = write_rows("turned.npy", {1, 3}, 2);
  expect_right({points, other, "--constraints", segments, "--constraint-edges", edges});
  expect_wrong({}, {points, other, "--constraints", segments, "--constraint-edges", turned});
  EXPECT_EQ(run_well({"verify", points, other, "--constraints", segments, "--quiet"}, kNoPlatform).out, "");
  const Outcome wrong = run({"verify", points, from_first, "--constraints", text, "--quiet"}, kNoPlatform);
  EXPECT_EQ(wrong.exit_code, kFailure);
  EXPECT_EQ(wrong.out, "");
  expect_parts(wrong.err, {"flaunay: "});

  // What is left of it: a triangle, by its border, by a hole, and by a file of its own.
  const std::string half = write_rows("half.npy", {0, 1, 3}), border = write("border.txt", "0 1\n1 3\n3 0\n");
  expect_right({points, half, "--constraints", border, "--outside", "hull", "--fill", "even-odd"});
  expect_right({points, half, "--constraints", text, "--hole", "3,3"});
  const std::string poly =
      write("border.poly", "4 2 0 0\n0 0 0\n1 4 0\n2 4 4\n3 0 4\n3 0\n0 0 1\n1 1 3\n2 3 0\n0\n");
  expect_right({poly, half});
  expect_wrong({}, {poly, half, "--outside", "keep"});

  expect_error(kUsage, {"--outside", "needs segments"}, {"verify", points, half, "--outside", "hull"});
  expect_error(kUsage, {"--memory"}, {"verify", points, other, "--constraints", text, "--memory", "64M"});
  expect_error(kUsage, {"border.poly", "segments of its own"}, {"verify", poly, half, "--constraints", text});
  expect_error(kUsage, {"edges.txt", ".npy"},
               {"verify", points, other, "--constraints", text, "--constraint-edges", path("edges.txt")});
  expect_error(kBadInput, {"beyond.txt: line 1", "index 7"},
               {"verify", points, other, "--constraints", write("beyond.txt", "0 7\n")});
}

TEST_F(CommandVerifyTest, OtherSpaces) {
  const std::string points = write("points.xy", "0 0\n4 0\n1 3\n3 4\n2 2\n2 2\n");
  const std::string weighted = write("w.txt", "0 0 0\n4 0 0\n0 4 0\n1 1 -9\n0 0 -1\n0 4 0\n");
  const auto check = [&](const std::string& input, const Arguments& space) {
    run_well(
        joined({"triangulate", input, "--triangles", path("t.npy"), "--neighbors", path("n.npy")}, space));
    const Arguments checked = joined({input, path("t.npy")}, space);
    expect_right(checked);
    expect_right(joined(checked, {"--neighbors", path("n.npy")}));
    expect_wrong({}, joined({input, write_rows("wrong.npy", {0, 1, 3, 1, 2, 3})}, space));
  };
  check(weighted, {"--weighted"});
  check(points, {"--sphere"});
  run_well(
      {"triangulate", points, "--period", "5,inf", "--triangles", path("t.npy"), "--offsets", path("o.npy")});
  const Arguments torus = {points, path("t.npy"), "--offsets", path("o.npy"), "--period"};
  expect_right(joined(torus, {"5,inf"}));
  expect_wrong({}, joined(torus, {"5,5"}));
  run_well({"triangulate", points, "--period", "30,2,7", "--triangles", path("t.npy"), "--offsets",
            path("o.npy")});
  expect_right(joined(torus, {"30,2,7"}));
  expect_wrong({}, joined(torus, {"30,2,-7"}));
  const Arguments with_weights = {"--weighted", "--offsets", path("o.npy"), "--period"};
  run_well(joined({"triangulate", weighted, "--triangles", path("t.npy")}, joined(with_weights, {"8,8,1"})));
  expect_right(joined({weighted, path("t.npy")}, joined(with_weights, {"8,8,1"})));
  expect_wrong({}, joined({write("heavy.txt", "0 0 0\n4 0 0\n0 4 0\n1 1 9\n0 0 -1\n0 4 0\n"), path("t.npy")},
                          joined(with_weights, {"8,8,1"})));
  // On a line or a circle, triangles do not say which points are hidden.
  const std::string none = write_rows("none.npy", {}), circle = write("circle.txt", "0 1 0\n1 1 9\n2 1 0\n");
  run_well(joined({"triangulate", circle, "--triangles", path("t.npy")}, joined(with_weights, {"8,inf"})));
  expect_right(joined({circle, path("t.npy")}, joined(with_weights, {"8,inf"})));
  expect_wrong({"one circle"}, joined({weighted, path("t.npy")}, joined(with_weights, {"8,inf"})));
  expect_right({write("line.txt", "0 0 0\n1 1 9\n2 2 0\n"), none, "--weighted"});
  expect_wrong({"collinear"}, {weighted, none, "--weighted"});

  expect_error(kUsage, {"--period", "--offsets"}, {"verify", points, none, "--period", "1,1"});
  expect_error(kUsage, {"--offsets", "needs --period"}, {"verify", points, none, "--offsets", "o.npy"});
  expect_error(kUsage, {"--hole", "--sphere"}, {"verify", points, none, "--sphere", "--hole", "1,1"});
  expect_error(
      kBadInput, {"o.npy", "4 rows", "0 triangles"},
      {"verify", points, none, "--period", "5,5", "--offsets", write_rows("o.npy", std::vector<int>(24), 6)});
  expect_error(kBadInput, {"o.npy", "row 0 has offset 700"},
               {"verify", points, none, "--period", "5,5", "--offsets",
                write_rows("o.npy", std::vector<int>(6, 700), 6)});
}

TEST_F(CommandVerifyTest, RefinedMeshes) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 1\n0 1\n");
  const std::string triangles = write_rows("t.npy", {0, 1, 2, 0, 2, 3}),
                    half = write_rows("half.npy", {0, 1, 2});
  const std::string poly =
      write("map.poly", "4 2 0 0\n0 0 0\n1 4 0\n2 4 1\n3 0 1\n5 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n4 0 2\n0\n");
  expect_right({points, triangles, "--min-angle", "14", "--max-area", "2"});
  expect_parts(expect_right({poly, triangles, "--min-angle", "30"}).out,
               {"; 5 constraint edges, 2 triangles with smaller angles, which the input has"});
  for (const std::string& input : {points, poly}) {
    expect_wrong({"has the area 2, which is above 1.5"}, {input, triangles, "--max-area", "1.5"});
  }
  expect_wrong({}, {points, triangles, "--min-angle", "30"});
  expect_wrong({}, {points, half, "--max-area", "2"});
  expect_right({write("hull.xy", "0 0\n4 0\n4 1\n"), half, "--max-area", "2"});
  for (const char* angle : {"-1", "35", "nan"}) {
    expect_error(kUsage, {"smallest angle"}, {"verify", points, triangles, "--min-angle", angle});
  }
  for (const char* area : {"-1", "nan"}) {
    expect_error(kUsage, {"--max-area"}, {"verify", points, triangles, "--max-area", area});
  }
  expect_error(kUsage, {"--memory"}, {"verify", points, triangles, "--min-angle", "20", "--memory", "64M"});
}

TEST_F(CommandVerifyTest, InChunks) {
  for (const char* ending : {".npy", ".xy", ".bin"}) {
    const std::string points = path(std::string("points") + ending);
    run_well({"generate", "kuzmin", "3000", "-o", points}, kNoPlatform);
    run_well({"triangulate", points, "--mode", "dwyer", "--triangles", path("t.npy"), "--neighbors",
              path("n.npy")},
             kNoPlatform);
    const std::vector<std::string> checked = {"verify", points, path("t.npy"), "--neighbors", path("n.npy")};
    const std::string in_memory = run_well(checked, kNoPlatform).out;
    const std::string out =
        run_well(joined(checked, {"--memory", "64M", "--scratch", path("")}), kNoPlatform).out;
    EXPECT_EQ(out.substr(0, out.find(';')), in_memory.substr(0, in_memory.find(';')));
    expect_parts(out, {"; in chunks within 64 MiB: "});
    EXPECT_EQ(in_memory.find("in chunks"), std::string::npos) << in_memory;
  }
}

TEST_F(CommandVerifyTest, InChunksWideIndicesAndWrongOnes) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 3\n0 4\n");
  const std::string triangles = write_rows<std::int64_t>("t.npy", {0, 1, 2, 0, 2, 3}),
                    right = write_rows<std::int64_t>("n.npy", {-1, 1, -1, -1, -1, 0}),
                    wrong = write_rows<std::int64_t>("w.npy", {1, -1, -1, -1, -1, 0}),
                    beyond = write_rows<std::int64_t>("b.npy", {0, 1, std::int64_t{1} << 33});
  expect_right({points, triangles, "--neighbors", right, "--memory", "64M"});
  expect_wrong({"t.npy: triangle 0 with points 0, 1, 2"},
               {points, triangles, "--neighbors", wrong, "--memory", "64M"});
  expect_wrong({"has a corner 8589934592"}, {points, beyond, "--memory", "64M"});
}

TEST_F(CommandVerifyTest, InChunksBadRequests) {
  const std::string points = write("points.xy", "0 0\n4 0\n0 4\n");
  const std::string triangles = write_rows("t.npy", {0, 1, 2});
  expect_error(kUsage, {"64 MiB"}, {"verify", points, triangles, "--memory", "1M"});
  expect_error(kUsage, {"t.obj", ".npy"}, {"verify", points, write("t.obj", "f 1 2 3\n"), "--memory", "64M"});
  expect_error(kBadInput, {"missing.npy"}, {"verify", points, path("missing.npy"), "--memory", "64M"});
  expect_error(
      kBadInput, {"short.npy", "truncated"},
      {"verify", points, write("short.npy", npy("<i4", "False", "(2, 3)", "123")), "--memory", "64M"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_error(
      kBadInput, {"nan.bin", "point 2 at (0, nan)"},
      {"verify", write("nan.bin", bytes_of<double>({0, 0, 4, 0, 0, nan})), triangles, "--memory", "64M"});
}

TEST_F(CommandVerifyTest, GenerateGivesTheSameBytesForTheSameSeed) {
  for (const auto& [name, seed] : {std::pair("a.xy", "7"), {"b.xy", "7"}, {"c.xy", "8"}}) {
    run_well({"generate", "kuzmin", "500", "--seed", seed, "-o", path(name)}, kNoPlatform);
  }
  EXPECT_GT(contents(path("a.xy")).size(), 1000u);
  EXPECT_EQ(contents(path("a.xy")), contents(path("b.xy")));
  EXPECT_NE(contents(path("a.xy")), contents(path("c.xy")));
}

TEST_F(CommandVerifyTest, GenerateToStandardOutputIsTheTextFile) {
  run_well({"generate", "normal", "5000", "-o", path("points.xy")}, kNoPlatform);
  EXPECT_EQ(run_well({"generate", "normal", "5000", "-o", "-"}, kNoPlatform).out,
            contents(path("points.xy")));
}

TEST_F(CommandVerifyTest, FullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Outcome outcome = run({"generate", "uniform", "5000", "-o", "-"}, kNoPlatform, "", "/dev/full");
  EXPECT_EQ(outcome.exit_code, kBadInput);
  expect_parts(outcome.err, {"No space left"});
  EXPECT_EQ(run({"generate", "--help"}, kNoPlatform, "", "/dev/full").err.find("internal"),
            std::string::npos);
}

/// The wait status of a run whose standard output has a reader that leaves after one byte, or at once.
int status_without_reader(const Arguments& arguments, bool one_byte) {
  int ends[2];
  if (pipe(ends) != 0) return -1;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  if (!one_byte) close(ends[0]);
  const pid_t child = spawn(arguments, kNoPlatform, &actions);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (one_byte) {
    char byte = 0;
    EXPECT_EQ(read(ends[0], &byte, 1), 1);
    close(ends[0]);
  }
  int status = -1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return status;
}

TEST_F(CommandVerifyTest, AReaderThatGoesAwayEndsAGenerator) {
  const int status = status_without_reader({"generate", "uniform", "200000", "-o", "-"}, true);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGPIPE) << status;
}

TEST_F(CommandVerifyTest, TheVerdictNeedsNoReader) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 3\n0 4\n");
  const std::string right = write("right.obj", "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 4 0\nf 1 2 3\nf 1 3 4\n");
  const int status = status_without_reader({"verify", points, right}, false);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == kSuccess) << status;
}

// ------------------------------------------------------------------------------------------------- progress

/// Runs with a terminal as standard error and an input that ends, badly, only after a while.
std::string terminal_output_of_slow_run(std::chrono::milliseconds wait, const Environment& environment) {
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return "no terminal";
  const int terminal_end = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  int ends[2];
  if (terminal_end < 0 || pipe(ends) != 0) return "no terminal";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, terminal_end, STDERR_FILENO);
  for (const int descriptor : {ends[0], ends[1], terminal, terminal_end}) {
    posix_spawn_file_actions_addclose(&actions, descriptor);
  }
  const pid_t child = spawn({"triangulate", "-"}, environment, &actions);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  close(terminal_end);
  std::this_thread::sleep_for(wait);
  const std::string text = "0 0\n1 oops\n";
  EXPECT_EQ(write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  close(ends[1]);
  std::string output;
  char buffer[4096];
  for (ssize_t count; (count = read(terminal, buffer, sizeof buffer)) > 0;) {
    output.append(buffer, static_cast<std::size_t>(count));
  }
  close(terminal);
  EXPECT_EQ(exit_code_of(child), kBadInput);
  return output;
}

TEST(CommandProgressTest, OneLineRewrittenAndClearedAtTheEnd) {
  Environment environment = kNoPlatform;
  environment["TERM"] = "xterm";
  const std::string clear = "\r\x1b[K";
  const std::string output = terminal_output_of_slow_run(std::chrono::milliseconds(900), environment);
  EXPECT_EQ(output.rfind(clear + "reading", 0), 0u) << output;
  const std::size_t message = output.find("flaunay: ");
  ASSERT_NE(message, std::string::npos) << output;
  EXPECT_EQ(output.substr(message - clear.size(), clear.size()), clear) << output;
  EXPECT_EQ(output.substr(0, message).find('\n'), std::string::npos) << output;
}

TEST(CommandProgressTest, NothingInTheFirstHalfSecondNorOnADumbTerminal) {
  for (const auto& [terminal, wait] : {std::pair("xterm", 0), {"dumb", 700}}) {
    Environment environment = kNoPlatform;
    environment["TERM"] = terminal;
    const std::string output = terminal_output_of_slow_run(std::chrono::milliseconds(wait), environment);
    EXPECT_EQ(output.rfind("flaunay: ", 0), 0u) << output;
  }
}

// --------------------------------------------------------------------------------------------------- device

using CommandDeviceTest = CommandTest;

TEST_F(CommandDeviceTest, NoPlatformSaysWhatToInstall) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n");
  const Arguments command = {"triangulate", points, "-o", path("mesh.off"), "--device", "pocl"};
  expect_error(kDevice, {"pocl-opencl-icd"}, command);
  const Outcome devices = run({"devices"}, kNoPlatform);
  EXPECT_EQ(devices.exit_code, kSuccess);
  expect_parts(devices.out, {"host"});
  expect_parts(devices.err, {"pocl-opencl-icd"});
}

// Small and large, with and without OpenCL, and on a device: the same bytes.
TEST_F(CommandDeviceTest, NoPlatformIsNeededOnTheHost) {
  for (const std::string n : {"1000", "50000"}) {
    const std::string points = path("points.npy");
    run_well({"generate", "uniform", n, "-o", points});
    run_well({"triangulate", points, "--device", "#0", "--triangles", path("device.npy")}, {});
    for (const Arguments& choice : {Arguments{}, Arguments{"--device", "host"}}) {
      for (const Environment& environment : {Environment{}, kNoPlatform}) {
        run_well(joined({"triangulate", points, "--triangles", path("host.npy")}, choice), environment);
        EXPECT_EQ(contents(path("host.npy")), contents(path("device.npy"))) << n << " points";
      }
    }
  }
}

TEST_F(CommandDeviceTest, UnknownDevice) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n");
  const Arguments command = {"triangulate", points, "-o", path("mesh.off")};
  for (const char* device : {"no such device", "#999"}) {
    expect_error(kDevice, {device}, joined(command, {"--device", device}), {});
    expect_error(kDevice, {device}, command, {{"FLAUNAY_DEVICE", device}});
  }
}

TEST_F(CommandDeviceTest, TooManyPointsSaysHowManyWouldFit) {
  // PoCL can be told to have one GiB.
  run_well({"generate", "uniform", "4000000", "-o", path("points.npy")}, {});
  expect_error(kDevice, {"4000000 points", "would fit", "1024 MiB of memory"},
               {"triangulate", path("points.npy"), "--device", "#0", "-o", path("mesh.off")},
               {{"POCL_MEMORY_LIMIT", "1"}});
}

TEST_F(CommandDeviceTest, WhatWouldFitDependsOnTheLimitsOfTheProcess) {
  if (flaunay::testing::is_sanitized())
    GTEST_SKIP() << "the limit leaves no room for the sanitizer's own memory";
  run_well({"generate", "uniform", "4000000", "-o", path("points.npy")}, {});
  // Enough for the driver, but not for the points, which take 1.2 GB at most. In kilobytes.
  const std::string limited = "ulimit -v 1200000; exec '" + flaunay::flaunay_executable() +
                              "' triangulate '" + path("points.npy") + "' -o '" + path("mesh.off") + "' 2>'" +
                              path("message") + "'";
  const int status = std::system(limited.c_str());
  EXPECT_EQ(WEXITSTATUS(status), kDevice);
  const std::string message = contents(path("message"));
  expect_parts(message, {"would fit", "ulimit -v"});
}

TEST_F(CommandDeviceTest, TheOptionGoesBeforeTheEnvironment) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n");
  run_well({"triangulate", points, "--device", "#0"}, {{"FLAUNAY_DEVICE", "no such device"}});
  run_well({"triangulate", points}, {{"FLAUNAY_DEVICE", "#0"}});
}

TEST_F(CommandDeviceTest, DevicesListsWhatMatters) {
  const std::string out = run_well({"devices"}).out;
  expect_parts(out, {"#0", "platform", "driver", "fp64", "memory", "available", "largest buffer", "units",
                     "self-test", "passed"});
}

// A kernel that is wrong is named, with the call that shows it.
TEST_F(CommandDeviceTest, TestsNameTheKernelThatDiffers) {
  const Arguments test = {"devices", "--test", "--device", "#0", "--only", "sets", "--points", "40"};
  EXPECT_NE(run_well(test).out.find(" 0 differences"), std::string::npos);

  const fs::path kernels = path("kernels"), mesh = kernels / "blocks/mesh.cl";
  fs::copy(fs::path(FLAUNAY_TEST_DATA) / "../../kernels", kernels, fs::copy_options::recursive);
  std::string text = contents(mesh);
  const std::string right = "? -1 : of.right / 3;";
  ASSERT_NE(text.find(right), std::string::npos);
  write_file(mesh, text.replace(text.find(right), right.size(), "? -1 : of.right / 3 + 1;"));
  const Outcome wrong = run(test, {{"FLAUNAY_KERNEL_PATH", kernels.string()}});
  EXPECT_EQ(wrong.exit_code, kFailure) << wrong.err;
  expect_parts(wrong.out, {"sets neighbors, value 7 of 102: 2 on the device, 1 on the host",
                           "kernel blocks/mesh: write_neighbors: DIFFERENT",
                           "(global int* restrict neighbors), byte 28 of 408: 2 on", "2 differences"});

  expect_error(kUsage, {"there are triangulate sets"},
               {"devices", "--test", "--device", "#0", "--only", "nothing"});
  expect_error(kUsage, {"the host is what devices are compared with"},
               {"devices", "--test", "--device", "host"});
  expect_error(kUsage, {"--test"}, {"devices", "--only", "sets"});
}

// ---------------------------------------------------------------------------------------------- triangulate

using CommandTriangulateTest = CommandTest;

TEST_F(CommandTriangulateTest, EveryFileOfTheTestDataIsTriangulatedExactly) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(flaunay::test_data())) {
    const std::string input = entry.path().string();
    if (entry.path().extension() != ".xy" && entry.path().extension() != ".las") continue;
    SCOPED_TRACE(input);
    ++count;
    run_well({"triangulate", input, "--triangles", path("t.npy"), "--neighbors", path("n.npy")});
    run_well({"verify", input, path("t.npy"), "--neighbors", path("n.npy")}, kNoPlatform);
  }
  EXPECT_GE(count, 9u);
}

TEST_F(CommandTriangulateTest, MeshesGoThroughPipes) {
  const std::string input = data("ukraine.xy");
  run_well({"triangulate", input, "-o", path("mesh.off"), "--quiet"});
  const Outcome piped = run({"triangulate", "-", "-o", "-"}, {}, contents(input));
  EXPECT_EQ(piped.exit_code, kSuccess);
  EXPECT_EQ(piped.out, contents(path("mesh.off")));
  expect_parts(piped.err, {"874 points"});
  EXPECT_EQ(run_well({"triangulate", input, "-o", "-", "--quiet"}).out, piped.out);
  EXPECT_EQ(
      run_well({"triangulate", data("airports.txt"), "--sphere", "-o", "-", "--quiet"}).out.substr(0, 3),
      "OFF");
}

TEST_F(CommandTriangulateTest, SaysThatNothingIsWritten) {
  const std::string input = data("ukraine.xy");
  const auto says = [&](const Arguments& options) {
    return run_well(joined({"triangulate", input}, options)).out.find("nothing was written") !=
           std::string::npos;
  };
  EXPECT_TRUE(says({}));
  EXPECT_FALSE(says({"--quiet"}));
  EXPECT_FALSE(says({"--profile"}));
  EXPECT_FALSE(says({"--hull", path("h.npy")}));
  EXPECT_FALSE(says({"--stats", path("s.json")}));
  EXPECT_FALSE(says({"--period", "99999,99999", "--offsets", path("o.npy")}));
}

TEST_F(CommandTriangulateTest, EveryMeshFormat) {
  const std::string input = data("ukraine.xy");
  for (const char* ending : {".ele", ".off", ".ply", ".msh", ".vtu", ".obj", ".npy", ".svg"}) {
    SCOPED_TRACE(ending);
    const std::string mesh = path("mesh" + std::string(ending));
    run_well({"triangulate", input, "-o", mesh});
    EXPECT_GT(fs::file_size(mesh), 1000u);
    // Triangles are not read from the others.
    if (!std::set<std::string>{".msh", ".vtu", ".svg"}.contains(ending)) {
      run_well({"verify", input, mesh}, kNoPlatform);
    }
  }
  // Triangle's pair of files is complete: its own points verify too.
  run_well({"verify", path("mesh.node"), path("mesh.ele")}, kNoPlatform);
  EXPECT_NE(contents(path("mesh.svg")).find("<svg"), std::string::npos);
  EXPECT_NE(contents(path("mesh.vtu")).find("UnstructuredGrid"), std::string::npos);
}

TEST_F(CommandTriangulateTest, EveryInputFormatGivesTheSameTriangles) {
  std::string expected;
  for (const char* ending : {".npy", ".node", ".xy", ".txt", ".csv", ".bin"}) {
    SCOPED_TRACE(ending);
    const std::string input = path("points" + std::string(ending));
    run_well({"generate", "kuzmin", "300", "-o", input}, kNoPlatform);
    run_well({"triangulate", input, "--triangles", path("t.npy")});
    const std::string triangles = contents(path("t.npy"));
    if (expected.empty()) expected = triangles;
    EXPECT_EQ(triangles, expected);
  }
  run_well({"triangulate", "-", "--triangles", path("t.npy")}, {}, contents(path("points.xy")));
  EXPECT_EQ(contents(path("t.npy")), expected);
}

TEST_F(CommandTriangulateTest, ArraysOfASquareWithADuplicate) {
  const std::string input = write("points.xy", "0 0\n1 0\n1 1\n0 1\n1 0\n");
  const Outcome outcome = run_well({"triangulate", input, "--triangles", path("t.npy"), "--neighbors",
                                    path("n.npy"), "--hull", path("h.npy"), "--duplicates", path("d.npy")});
  const Array triangles = read_array(path("t.npy")), neighbors = read_array(path("n.npy"));
  const Array hull = read_array(path("h.npy")), duplicates = read_array(path("d.npy"));
  EXPECT_EQ(triangles.shape, "(2, 3)");
  EXPECT_EQ(neighbors.shape, "(2, 3)");
  EXPECT_EQ(hull.shape, "(4,)");
  EXPECT_EQ(duplicates.shape, "(5,)");
  EXPECT_EQ(hull.values, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(duplicates.values, (Indices{0, 1, 2, 3, 1}));
  // The four points are on a circle: a fan from the smallest, whatever the order of the rows.
  EXPECT_EQ(sorted_rows(path("t.npy")), (Rows{{0, 1, 2}, {0, 2, 3}}));
  expect_parts(outcome.out,
               {"5 points", "1 duplicate", "2 triangles", "4 hull vertices", "points per second"});
}

TEST_F(CommandTriangulateTest, DegenerateInputHasADefinedResult) {
  const std::vector<std::tuple<std::string, Indices, Indices>> cases = {
      {"# none\n", {}, {}},
      {"3 4\n", {0}, {0}},
      {"1 5\n1 -5\n1 0\n1 5\n", {1, 2, 0}, {0, 1, 2, 0}},
      {"0 0\n-0 0\n0 -0\n", {0}, {0, 0, 0}},
  };
  for (const auto& [text, hull, representatives] : cases) {
    SCOPED_TRACE(text);
    const std::string input = write("points.xy", text);
    const Outcome outcome = run_well({"triangulate", input, "--triangles", path("t.npy"), "--neighbors",
                                      path("n.npy"), "--hull", path("h.npy"), "--duplicates", path("d.npy")});
    expect_parts(outcome.out, {"note: ", "0 triangles"});
    EXPECT_EQ(read_array(path("t.npy")).shape, "(0, 3)");
    EXPECT_EQ(read_array(path("n.npy")).shape, "(0, 3)");
    EXPECT_EQ(read_array(path("h.npy")).values, hull);
    EXPECT_EQ(read_array(path("d.npy")).values, representatives);
    run_well({"verify", input, path("t.npy")}, kNoPlatform);
    for (const std::string ending : {".ele", ".off", ".ply", ".msh", ".vtu", ".obj", ".npy", ".svg"}) {
      run_well({"triangulate", input, "-o", path("mesh" + ending)});
      EXPECT_TRUE(fs::exists(path("mesh" + ending)));
    }
  }
}

TEST_F(CommandTriangulateTest, StatisticsAreComplete) {
  run_well({"generate", "uniform", "2000", "-o", path("points.npy")}, kNoPlatform);
  const Outcome outcome =
      run_well({"triangulate", path("points.npy"), "--mode", "flattened", "--finish", "levels", "--cut",
                "alternate", "--stats", path("stats.json"), "--profile"});
  expect_parts(outcome.out, {"kernel"});
  const auto stats = json_of(path("stats.json"));
  EXPECT_EQ(stats.value("points", 0), 2000);
  EXPECT_EQ(stats.value("duplicates", -1), 0);
  EXPECT_EQ(stats.value("triangles", 0), 2 * 2000 - 2 - stats.value("hull_vertices", 0));
  EXPECT_EQ(stats.value("mode", ""), "flattened");
  EXPECT_EQ(stats.value("cut", ""), "alternate");
  EXPECT_FALSE(stats.value("device", "").empty());
  EXPECT_FALSE(stats.value("flaunay", "").empty());
  EXPECT_GT(stats.value("kernel_launches", 0), 0);
  EXPECT_EQ(stats.value("host_waits", -1), 0);  // of a device; the host is none
  EXPECT_GT(stats.value("device_bytes_peak", 0), 0);
  EXPECT_GT(stats.value("device_bytes_per_point", 0.0), 0);
  EXPECT_TRUE(stats.contains("undecided_predicates"));
  for (const char* part : {"reading", "opening_device", "building_programs", "triangulating", "writing"}) {
    EXPECT_TRUE(stats["seconds"].contains(part)) << part;
  }
  ASSERT_FALSE(stats["phases"].empty());
  EXPECT_TRUE(stats["phases"][0].contains("name") && stats["phases"][0].contains("seconds"));
  ASSERT_FALSE(stats["levels"].empty());
  EXPECT_EQ(stats["levels"][0].value("regions", 0), 1);
  for (const char* part :
       {"internal_points", "corners", "survivors", "path_vertices", "hull_rounds", "seconds"}) {
    EXPECT_TRUE(stats["levels"][0].contains(part)) << part;
  }
  ASSERT_FALSE(stats["kernels"].empty());
  EXPECT_GT(stats["kernels"][0].value("launches", 0), 0);
}

TEST_F(CommandTriangulateTest, ACacheThatOthersCanWriteToIsSaidOnce) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 3\n0 4\n1 1\n");
  const std::string map = write("map.poly", "4 2 0 0\n0 0 0\n1 4 0\n2 4 3\n3 0 4\n1 0\n0 0 2\n0\n");
  fs::create_directory(path("cache"));
  const auto notes = [&](const Arguments& arguments) {
    const std::string out =
        run_well(joined(arguments, {"--device", "#0"}), {{"FLAUNAY_CACHE_DIR", path("cache")}}).out;
    const std::string line = "note: compiled kernels are not kept in " + path("cache") + ": its mode 0777";
    std::size_t count = 0;
    for (std::size_t at = 0; (at = out.find(line, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  const std::vector<Arguments> runs = {
      {"triangulate", points},
      {"triangulate", points, "--mode", "flattened"},
      {"triangulate", points, "--chunk-points", "2", "--stats", path("s.json")},
      {"triangulate", map}};
  fs::permissions(path("cache"), fs::perms::all);
  for (const Arguments& arguments : runs) EXPECT_EQ(notes(arguments), 1U) << arguments.back();
  EXPECT_EQ(json_of(path("s.json"))["chunks"].value("host_points", -1), 0);
  EXPECT_TRUE(fs::is_empty(path("cache")));
  fs::permissions(path("cache"), fs::perms::owner_all);
  EXPECT_EQ(notes(runs.front()), 0U);
}

TEST_F(CommandTriangulateTest, TimesAddUpAndCompilingIsNoneOfThem) {
  for (const std::string mode : {"blocks", "flattened"}) {
    SCOPED_TRACE(mode);
    // In a new cache, so that everything is compiled; of the other mode that takes long.
    Environment environment;
    if (mode == "blocks") environment["POCL_CACHE_DIR"] = path("cache");
    run_well({"generate", "uniform", "3000", "-o", path("points.npy")}, kNoPlatform);
    const Outcome outcome = run_well(
        {"triangulate", path("points.npy"), "--mode", mode, "--device", "#0", "--stats", path("stats.json")},
        environment);
    expect_parts(outcome.out, {", compiling kernels "});
    const auto stats = json_of(path("stats.json"));
    const double triangulating = stats["seconds"].value("triangulating", 0.0);
    double phases = 0;
    for (const auto& phase : stats["phases"]) phases += phase.value("seconds", 0.0);
    EXPECT_NEAR(phases, triangulating, 1e-6);
    if (mode == "blocks") {
      EXPECT_GT(stats["seconds"].value("building_programs", 0.0), triangulating) << outcome.out;
    }
    EXPECT_NEAR(stats.value("points_per_second", 0.0) * triangulating, 3000, 1e-3);
  }
}

TEST_F(CommandTriangulateTest, BlocksIsTheDefault) {
  run_well({"triangulate", data("ukraine.xy"), "--stats", path("stats.json"), "--profile"});
  const auto stats = json_of(path("stats.json"));
  EXPECT_EQ(stats.value("mode", ""), "blocks");
  EXPECT_TRUE(stats["cut"].is_null());
  EXPECT_EQ(stats["phases"].size(), 3U);
  EXPECT_GT(stats["kernels"].size(), 5U);
}

TEST_F(CommandTriangulateTest, QuietSaysNothing) {
  const std::string input = data("robustness1.xy");
  EXPECT_EQ(run_well({"triangulate", input, "--quiet", "-o", path("mesh.off")}).out, "");
  EXPECT_TRUE(fs::exists(path("mesh.off")));
  const std::string line = write("line.xy", "0 0\n1 1\n2 2\n");
  EXPECT_EQ(run_well({"triangulate", line, "--quiet", "--profile"}).out, "");
}

TEST_F(CommandTriangulateTest, OutOfRangeNamesThePointAndWritesNothing) {
  const std::string input = write("points.xy", "0 0\n1 0\n0 1e-300\n1e300 1\n");
  expect_error(kBadInput, {"point"}, {"triangulate", input, "-o", path("mesh.off"), "--hull", path("h.npy")},
               {});
}

TEST_F(CommandTriangulateTest, AFailedWriteLeavesNoFileBehind) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  fs::create_symlink("/dev/full", path("hull.npy"));
  expect_error(kBadInput, {"hull.npy"},
               {"triangulate", data("ukraine.xy"), "-o", path("mesh.ele"), "--triangles", path("t.npy"),
                "--hull", path("hull.npy")},
               {});
}

TEST_F(CommandTriangulateTest, EveryModeGivesTheSameTriangles) {
  std::vector<Arguments> modes = {
      {"--mode", "flattened", "--hull-variant", "quickhull"},
      {"--mode", "flattened", "--hull-variant", "balanced"},
      {"--mode", "flattened", "--finish", "levels"},
      {"--mode", "flattened", "--cut", "alternate"},
      {"--mode", "recursive", "--hull-variant", "monotone-chain", "--cut", "alternate"},
      {"--mode", "partition", "--partition-levels", "3", "--threads", "2"}};
  for (const research::ModeInfo& info : research::list_modes()) modes.push_back({"--mode", info.name});
  run_well({"generate", "half-duplicates", "400", "-o", path("points.npy")}, kNoPlatform);
  run_well({"triangulate", path("points.npy"), "--triangles", path("expected.npy")});
  for (const Arguments& mode : modes) {
    SCOPED_TRACE(mode[1] + " " + mode.back());
    run_well(joined(
        {"triangulate", path("points.npy"), "--triangles", path("t.npy"), "--neighbors", path("n.npy")},
        mode));
    EXPECT_EQ(sorted_rows(path("t.npy")), sorted_rows(path("expected.npy")));
    run_well({"verify", path("points.npy"), path("t.npy"), "--neighbors", path("n.npy")}, kNoPlatform);
  }
}

TEST_F(CommandTriangulateTest, WhatAHostModeDoesNotHaveIsNull) {
  const Outcome outcome = run_well(
      {"triangulate", data("ukraine.xy"), "--mode", "dwyer", "--stats", path("stats.json")}, kNoPlatform);
  expect_parts(outcome.out, {"triangulated on the host in"});
  const auto stats = json_of(path("stats.json"));
  EXPECT_EQ(stats.value("device", ""), "host");
  for (const char* key : {"cut", "hull_variant"}) {
    ASSERT_TRUE(stats.contains(key)) << key;
    EXPECT_TRUE(stats[key].is_null()) << key;
  }
  EXPECT_EQ(stats.value("mode", ""), "dwyer");
  EXPECT_GT(stats.value("triangles", 0), 0);
}

TEST_F(CommandTriangulateTest, CountPrintsATableByComponent) {
  for (const char* mode : {"flattened", "recursive", "dwyer"}) {
    SCOPED_TRACE(mode);
    const Outcome outcome = run_well(
        {"triangulate", data("ukraine.xy"), "--mode", mode, "--count", "--stats", path("stats.json")});
    expect_parts(outcome.out,
                 {"operations a point", "arithmetic", "depths", "orientations", "circles", "critical path",
                  "\ncut ", "\nhull ", "\nmerge ", "\nsplit ", "\nend game ", "\ntotal "});
    const auto stats = json_of(path("stats.json"));
    ASSERT_TRUE(stats.contains("work"));
    EXPECT_GT(stats["work"]["levels"][0]["merge"].value("operations", 0), 0);
  }
  // No points, no division by their number.
  const std::string none = write("none.xy", "# none\n");
  run_well({"triangulate", none, "--mode", "dwyer", "--count"}, kNoPlatform);
}

// ------------------------------------------------------------------------------------------------- surfaces

// All of the globe, each place once, without a side across the date line.
TEST_F(CommandTriangulateTest, TheGlobeAsGeoJson) {
  std::string text = "170 10\n-170 -10\n0 90\n180 0\n-180 20\n";
  for (int i = 0; i < 60; ++i)
    text += std::to_string(i * 137 % 360 - 180) + " " + std::to_string(i * 61 % 170 - 85) + "\n";
  for (const std::string more : {"", "5 -90\n"}) {
    run_well({"triangulate", write("globe.txt", text + more), "--sphere", "-o", path("globe.geojson")});
    double area = 0;
    const nlohmann::json globe = json_of(path("globe.geojson"));
    for (const auto& feature : globe["features"]) {
      for (const auto& polygon : feature["geometry"]["coordinates"]) {
        const auto& ring = polygon[0];
        double twice = 0;
        for (std::size_t k = 0; k + 1 < ring.size(); ++k) {
          const double x = ring[k][0], y = ring[k][1], to = ring[k + 1][0], up = ring[k + 1][1];
          EXPECT_TRUE(std::fabs(x) <= 180 && std::fabs(y) <= 90) << x << " " << y;
          EXPECT_TRUE(std::fabs(to - x) <= 180 || std::fabs(y) == 90) << x << " " << to;
          twice += x * up - to * y;
        }
        EXPECT_GT(twice, 0);
        EXPECT_EQ(ring.front(), ring.back());
        area += twice / 2;
      }
    }
    EXPECT_NEAR(area, 360 * 180, 1e-6);
  }
}

TEST_F(CommandTriangulateTest, OtherSurfaces) {
  const std::string points = write("points.xy", "0.5 0\n-7 9\n0.5 4\n30 40\n");
  // One of the points is given twice.
  const Outcome outcome = run_well({"triangulate", points, "--period", "2,4", "--triangles", path("t.npy"),
                                    "--neighbors", path("n.npy"), "--offsets", path("o.npy"), "--duplicates",
                                    path("d.npy"), "--points", path("p.xy"), "--stats", path("s.json")});
  expect_parts(outcome.out, {"4 points, 1 duplicate, 6 triangles"});
  EXPECT_EQ(read_array(path("t.npy")).shape, "(6, 3)");
  EXPECT_EQ(read_array(path("o.npy")).shape, "(6, 6)");
  EXPECT_EQ(read_array(path("d.npy")).values, (Indices{0, 1, 0, 3}));
  for (const std::int32_t t : read_array(path("n.npy")).values) EXPECT_GE(t, 0);
  for (const std::int32_t step : read_array(path("o.npy")).values) EXPECT_LE(std::abs(step), 1);
  EXPECT_EQ(contents(path("p.xy")), "# x y\n0.5 0\n1 1\n0.5 0\n0 0\n");
  EXPECT_EQ(json_of(path("s.json"))["triangles"], 6);
  run_well({"triangulate", points, "--period", "inf,4", "--triangles", path("t.npy"), "--quiet"});
  EXPECT_EQ(read_array(path("t.npy")).shape, "(4, 3)");
  // In chunks, with the same triangles and duplicates.
  const auto triangulate = [&](Arguments arguments) {
    arguments.insert(arguments.end(),
                     {"--period", "3,inf", "--triangles", path("t.npy"), "--offsets", path("o.npy"),
                      "--duplicates", path("d.npy"), "--stats", path("s.json"), "--quiet"});
    arguments.insert(arguments.begin(), {"triangulate", data("ukraine.xy")});
    run_well(arguments);
    return std::pair(sorted_rows(path("t.npy")), contents(path("d.npy")));
  };
  const auto expected = triangulate({});
  EXPECT_EQ(triangulate({"--chunk-points", "50", "--memory", "300M"}), expected);
  EXPECT_NE(contents(path("o.npy")).find("|i1"), std::string::npos);
  const auto chunks = json_of(path("s.json"))["chunks"];
  EXPECT_GT(chunks["number"], 2);
  EXPECT_GT(chunks["images"], 0);
  // A tetrahedron's corners.
  const std::string globe = write("globe.xy", "0 -20\n120 -20\n240 -20\n0 90\n");
  run_well({"triangulate", globe, "--sphere", "--triangles", path("t.npy"), "--quiet"});
  EXPECT_EQ(read_array(path("t.npy")).shape, "(4, 3)");
}

TEST_F(CommandTriangulateTest, WeightedPoints) {
  const std::string points = write("points.xyz", "0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 2 -8\n1 2 3\n");
  const Outcome outcome =
      run_well({"triangulate", points, "--weighted", "--triangles", path("t.npy"), "--hidden", path("h.npy"),
                "--hull", path("hull.npy"), "--output", path("mesh.obj"), "--stats", path("s.json")});
  expect_parts(outcome.out, {"hidden points: 1"});
  EXPECT_EQ(read_array(path("t.npy")).shape, "(4, 3)");
  EXPECT_EQ(read_array(path("h.npy")).values, (Indices{4}));
  EXPECT_EQ(read_array(path("hull.npy")).values, (Indices{0, 1, 2, 3}));
  EXPECT_EQ(json_of(path("s.json"))["triangles"], 4);
}

TEST_F(CommandTriangulateTest, WeightedPointsWithAPeriod) {
  const std::string points = write("points.xyz", "0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 2 -8\n1 2 3\n");
  const Outcome outcome =
      run_well({"triangulate", points, "--weighted", "--period", "8,8,1", "--triangles", path("t.npy"),
                "--hidden", path("h.npy"), "--offsets", path("o.npy"), "--output", path("mesh.obj")});
  expect_parts(outcome.out, {"hidden points: 1"});
  EXPECT_EQ(read_array(path("t.npy")).shape, "(10, 3)");
  EXPECT_EQ(read_array(path("h.npy")).values, (Indices{4}));
}

// --------------------------------------------------------------------------------------------------- chunks

class CommandChunksTest : public ArraysTest {
 protected:
  Arguments triangulate(const std::string& input, const Arguments& options) const {
    Arguments all = {"triangulate", input};
    for (const std::string array : {"triangles", "neighbors", "hull", "duplicates"}) {
      all.insert(all.end(), {"--" + array, path(array) + ".npy"});
    }
    return joined(all, options);
  }
  /// The files are those of the call that was made before, but for the order of triangles.
  void expect_same(const Rows& triangles, const Array& hull, const Array& duplicates, bool is_wide) const {
    for (const char* name : {"triangles.npy", "neighbors.npy", "hull.npy", "duplicates.npy"}) {
      EXPECT_EQ(read_array(path(name)).is_wide, is_wide) << name;
    }
    EXPECT_EQ(sorted_rows(path("triangles.npy")), triangles);
    EXPECT_EQ(read_array(path("hull.npy")).values, hull.values);
    EXPECT_EQ(read_array(path("hull.npy")).shape, hull.shape);
    EXPECT_EQ(read_array(path("duplicates.npy")).values, duplicates.values);
  }
};

TEST_F(CommandChunksTest, EveryFormatHasTheTriangulationOfOneCall) {
  run_well({"generate", "small-integers", "4000", "-o", path("points.npy")}, kNoPlatform);
  run_well(triangulate(path("points.npy"), {"--quiet"}), kNoPlatform);
  const Rows triangles = sorted_rows(path("triangles.npy"));
  const Array hull = read_array(path("hull.npy")), duplicates = read_array(path("duplicates.npy"));
  for (const char* ending : {".npy", ".node", ".xy", ".csv", ".bin"}) {
    const std::string input = path("points" + std::string(ending));
    run_well({"generate", "small-integers", "4000", "-o", input}, kNoPlatform);
    for (const Arguments& options :
         {Arguments{"--chunk-points", "500"}, Arguments{"--memory", "1G", "--scratch", path("")},
          Arguments{"--chunk-points", "900", "--index", "64"}, Arguments{"--device", "host,host"}}) {
      SCOPED_TRACE(input + " " + options[0] + " " + options[1]);
      const std::vector<std::string> before = files();
      const Outcome outcome = run_well(triangulate(input, options), kNoPlatform);
      expect_parts(outcome.out, {" chunk"});
      expect_same(triangles, hull, duplicates, options.size() == 4 && options[3] == "64");
      run_well({"verify", input, path("triangles.npy"), "--neighbors", path("neighbors.npy")}, kNoPlatform);
      EXPECT_EQ(files(), before) << "something was left";
    }
  }
  run_well(triangulate("-", {"--chunk-points", "500"}), kNoPlatform, contents(path("points.xy")));
  expect_same(triangles, hull, duplicates, false);
}

TEST_F(CommandChunksTest, IndicesOf64BitsWithoutChunks) {
  run_well({"generate", "uniform", "500", "-o", path("points.npy")}, kNoPlatform);
  run_well(triangulate(path("points.npy"), {"--index", "32"}), kNoPlatform);
  const Rows triangles = sorted_rows(path("triangles.npy"));
  const Array hull = read_array(path("hull.npy")), duplicates = read_array(path("duplicates.npy"));
  run_well(triangulate(path("points.npy"), {"--index", "64"}), kNoPlatform);
  expect_same(triangles, hull, duplicates, true);
}

TEST_F(CommandChunksTest, StatisticsHaveRoundsAndDevices) {
  run_well({"generate", "uniform", "5000", "-o", path("points.npy")}, kNoPlatform);
  run_well({"triangulate", path("points.npy"), "--chunk-points", "500", "--stats", path("s.json")},
           kNoPlatform);
  const nlohmann::json statistics = json_of(path("s.json"));
  EXPECT_EQ(statistics["points"], 5000);
  EXPECT_EQ(statistics["mode"], "blocks");
  EXPECT_GT(statistics["points_per_second"], 0);
  EXPECT_FALSE(statistics["phases"].empty());
  const nlohmann::json& chunks = statistics["chunks"];
  ASSERT_FALSE(chunks["rounds"].empty());
  EXPECT_EQ(chunks["rounds"][0]["points"], 5000);
  std::uint64_t number = 0, triangles = 0;
  for (const nlohmann::json& round : chunks["rounds"]) {
    number += round["chunks"].get<std::uint64_t>();
    triangles += round["triangles"].get<std::uint64_t>();
  }
  EXPECT_EQ(chunks["number"], number);
  EXPECT_GT(number, 1u);
  EXPECT_EQ(statistics["triangles"], triangles);
  ASSERT_EQ(chunks["devices"].size(), 1u);
  EXPECT_EQ(chunks["devices"][0]["device"], "host");
  EXPECT_GE(chunks["devices"][0]["points"], 5000);
}

TEST_F(CommandChunksTest, WhatChunksCannotDoIsRefusedFirst) {
  // The input is missing: that the option is what is complained of shows that it comes first.
  const auto refused = [this](const std::vector<std::string>& parts, const Arguments& arguments) {
    expect_error(kUsage, parts, joined({"triangulate", path("missing.xy")}, arguments));
  };
  for (const Arguments& chunks : {Arguments{"--memory", "4G"}, Arguments{"--chunk-points", "50"},
                                  Arguments{"--device", "all"}, Arguments{"--device", "host,#0"}}) {
    refused({"--output", "--triangles"}, joined(chunks, {"-o", path("mesh.off")}));
    refused({"--profile"}, joined(chunks, {"--profile"}));
    refused({"--count"}, joined(chunks, {"--count"}));
    refused({"--mode", "blocks", "flattened"}, joined(chunks, {"--mode", "flattened"}));
  }
  refused({"--memory", "-4G"}, {"--memory", "-4G"});
  refused({"--memory", "0"}, {"--memory", "0"});
  refused({"--memory", "unit"}, {"--memory", "4X"});
  refused({"--memory"}, {"--memory", "99999999999T"});
  refused({"--chunk-points", "0"}, {"--chunk-points", "0"});
  refused({"--chunk-points", "-5"}, {"--chunk-points", "-5"});
  refused({"--index", "16"}, {"--index", "16"});
  refused({"--scratch", "nowhere"}, {"--memory", "1G", "--scratch", path("nowhere")});
  refused({"--device", "host,"}, {"--device", "host,"});
  refused({"--device", ",host"}, {"--device", ",host"});
}

TEST_F(CommandChunksTest, WrongInputAndOutput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string last = write_rows<double>("last.npy", {0, 0, 1, 0, 0, 1, 1, nan}, 2),
                    text = write("points.xy", "0 0\n1 0\n0 1x\n");
  const Arguments chunks = {"--chunk-points", "2"};
  expect_error(kBadInput, {last + ": point 3 is not finite"}, triangulate(last, chunks));
  expect_error(kBadInput, {"points.xy", "line 3, column 3"}, triangulate(text, chunks));
  expect_error(kBadInput, {"missing.bin", "No such file"}, triangulate(path("missing.bin"), chunks));
  expect_error(kBadInput, {"scan.laz", "compressed"}, triangulate(write("scan.laz", "LASF"), chunks));
  ASSERT_EQ(mkfifo(path("pipe.npy").c_str(), 0600), 0);
  expect_error(kUsage, {"pipe.npy", "no regular file"},
               {"triangulate", text, "--memory", "1G", "--triangles", path("pipe.npy")});
  expect_error(kDevice, {"no such device"},
               triangulate(write("good.xy", "0 0\n1 0\n0 1\n"), {"--device", "host,no such device"}), {});
}

TEST_F(CommandChunksTest, DegenerateInput) {
  for (const auto& [text, rows] : {std::pair("# none\n", 0),
                                   {"1 1\n", 0},
                                   {"1 1\n1 1\n", 0},
                                   {"0 0\n1 1\n2 2\n3 3\n", 0},
                                   {"0 0\n1 0\n0 1\n", 1}}) {
    SCOPED_TRACE(text);
    const std::string input = write("points.xy", text);
    run_well(triangulate(input, {}), kNoPlatform);
    const Array hull = read_array(path("hull.npy")), duplicates = read_array(path("duplicates.npy"));
    run_well(triangulate(input, {"--chunk-points", "2"}), kNoPlatform);
    EXPECT_EQ(read_array(path("triangles.npy")).shape, "(" + std::to_string(rows) + ", 3)");
    EXPECT_EQ(read_array(path("hull.npy")).values, hull.values);
    EXPECT_EQ(read_array(path("duplicates.npy")).values, duplicates.values);
  }
}

// PoCL can be told to have one GiB, which 4 million points do not fit.
// ------------------------------------------------------------------------------------ partition and assemble

class CommandPartitionTest : public ArraysTest {
 protected:
  /// Points of a distribution in points.npy, and their partition in the folder p.
  void make(const std::string& distribution, const std::string& count, const std::string& levels) const {
    run_well({"generate", distribution, count, "-o", path("points.npy")}, kNoPlatform);
    fs::remove_all(path("p"));
    run_well({"partition", path("points.npy"), "--levels", levels, "-o", path("p")});
  }

  std::size_t regions() const {
    const auto json = json_of(path("p/partition.json"));
    return json.is_object() ? json.value("number_of_regions", std::size_t{0}) : 0;
  }

  std::string stem(std::size_t r) const { return path("p/region-0000" + std::to_string(r)); }

  /// Expects that assembling gives what triangulating gives.
  void expect_whole(const Arguments& options = {}) const {
    const std::string input = path("points.npy");
    run_well({"triangulate", input, "--mode", "dwyer", "--triangles", path("expected.npy"), "--hull",
              path("expected-hull.npy"), "--duplicates", path("expected-duplicates.npy")},
             kNoPlatform);
    Arguments command = {"assemble",    input,         path("p"),       "--triangles", path("t.npy"),
                         "--neighbors", path("n.npy"), "--hull",        path("h.npy"), "--duplicates",
                         path("d.npy"), "-o",          path("mesh.off")};
    command.insert(command.end(), options.begin(), options.end());
    run_well(command, kNoPlatform);
    EXPECT_EQ(sorted_rows(path("t.npy")), sorted_rows(path("expected.npy")));
    EXPECT_EQ(contents(path("h.npy")), contents(path("expected-hull.npy")));
    EXPECT_EQ(contents(path("d.npy")), contents(path("expected-duplicates.npy")));
    run_well({"verify", input, path("t.npy"), "--neighbors", path("n.npy")}, kNoPlatform);
  }

  void solve(std::size_t r, const std::string& ending) const {
    run_well({"triangulate", stem(r) + ".node", "--mode", "dwyer", "-o", stem(r) + ending}, kNoPlatform);
  }

  /// A text file of the partition, changed; expects that assembling names the file. Puts it back.
  void expect_broken(const std::string& name, const std::string& text,
                     const std::vector<std::string>& parts) const {
    const std::string before = contents(path(name));
    write_file(path(name), text);
    std::vector<std::string> all = parts;
    all.push_back(name);
    expect_error(kBadInput, all, {"assemble", path("points.npy"), path("p"), "--solve", "-o", path("m.off")});
    write_file(path(name), before);
  }

  /// The names of what is in the partition's folder, sorted.
  std::vector<std::string> folder() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path("p")))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST_F(CommandPartitionTest, WritesWhatItSays) {
  run_well({"generate", "uniform", "1000", "-o", path("points.npy")}, kNoPlatform);
  const Outcome outcome = run_well(
      {"partition", path("points.npy"), "--levels", "2", "-o", path("p"), "--picture", path("p/p.svg")});
  expect_parts(outcome.out,
               {"1000 points", "4 regions", "finished", "partitioned on the host in", "points per second"});
  EXPECT_EQ(folder().size(), 2 * 4u + 2 + 1);
  EXPECT_NE(contents(path("p/p.svg")).find("4 regions"), std::string::npos);
  EXPECT_NE(contents(path("p/p.svg")).find("</svg>"), std::string::npos);
  EXPECT_EQ(read_array(path("p/finished.npy")).shape, "(0, 3)");

  const auto json = json_of(path("p/partition.json"));
  EXPECT_EQ(json.value("points", 0), 1000);
  EXPECT_EQ(json.value("levels", 0), 2);
  EXPECT_EQ(json.value("input", ""), path("points.npy"));
  EXPECT_FALSE(json.value("device", "").empty());
  EXPECT_FALSE(json.value("flaunay", "").empty());
  ASSERT_EQ(json["regions"].size(), 4u);
  std::size_t points = 0;
  for (std::size_t r = 0; r < 4; ++r) {
    points += json["regions"][r].value("points", std::size_t{0});
    const std::string border = std::to_string(json["regions"][r].value("border_edges", 0));
    EXPECT_EQ(contents(stem(r) + ".poly").rfind("0 2 1 1\n" + border + " 0\n", 0), 0u);
  }
  EXPECT_GT(points, 1000u) << "borders are shared";
}

TEST_F(CommandPartitionTest, ANodeHasIndicesAndMarkersAndReadsBackExactly) {
  write_file(path("points.xy"), "0 0\n3 0.1\n3 3\n0 3\n1.0000000000000002 1e-1\n");
  run_well({"partition", path("points.xy"), "--levels", "0", "-o", path("p")});
  const std::string node = contents(path("p/region-00000.node"));
  EXPECT_EQ(node.rfind("5 2 1 1\n", 0), 0u) << node;
  expect_parts(node, {" 0 0 0 1\n", " 3 0.1 1 1\n", " 1.0000000000000002 0.1 4 0\n"});
}

TEST_F(CommandPartitionTest, SolvedHere) {
  for (const char* distribution : {"uniform", "kuzmin", "grid", "hexagonal", "integer-circle",
                                   "half-duplicates", "small-integers", "columns", "collinear"}) {
    SCOPED_TRACE(distribution);
    make(distribution, "600", "3");
    // Without points inside there is nothing left to solve.
    const std::string name = distribution;
    EXPECT_EQ(regions() == 0, name == "collinear" || name == "integer-circle");
    expect_whole({"--solve", "--threads", "2"});
  }
}

TEST_F(CommandPartitionTest, TinyInput) {
  for (const char* text : {"# none\n", "1 2\n", "1 2\n1 2\n", "0 0\n1 1\n2 2\n", "0 0\n1 0\n0 1\n",
                           "0 0\n1 0\n0 1\n1 1\n", "0 0\n2 0\n0 2\n2 2\n1 1\n"}) {
    SCOPED_TRACE(text);
    for (const char* levels : {"0", "1", "5"}) {
      fs::remove_all(path("p"));
      const std::string input = write("points.xy", text);
      run_well({"partition", input, "--levels", levels, "-o", path("p"), "--picture", path("p.svg")});
      run_well({"triangulate", input, "--mode", "dwyer", "--triangles", path("expected.npy")}, kNoPlatform);
      run_well({"assemble", input, path("p"), "--solve", "--triangles", path("t.npy")}, kNoPlatform);
      EXPECT_EQ(sorted_rows(path("t.npy")), sorted_rows(path("expected.npy")));
    }
  }
}

TEST_F(CommandPartitionTest, SolvedByOtherProgramsInEveryFormat) {
  for (const char* distribution : {"uniform", "grid", "half-duplicates"}) {
    SCOPED_TRACE(distribution);
    make(distribution, "500", "2");
    ASSERT_EQ(regions(), 4u);
    solve(0, ".npy");
    // A mesh as .ele brings its .node, the numbers of the region's own points.
    solve(1, ".1.ele");
    run_well({"triangulate", stem(2) + ".node", "--mode", "dwyer", "-o", path("other.ele")}, kNoPlatform);
    fs::copy_file(path("other.ele"), stem(2) + ".ele");
    // Numbered from 1, turned over.
    run_well({"triangulate", stem(3) + ".node", "--mode", "dwyer", "--triangles", path("other.npy")},
             kNoPlatform);
    const Rows rows = sorted_rows(path("other.npy"));
    std::string ele = std::to_string(rows.size()) + " 3 0\n";
    for (std::size_t t = 0; t < rows.size(); ++t) {
      ele += std::to_string(t + 1);
      for (const std::int32_t vertex : {rows[t][2], rows[t][1], rows[t][0]})
        ele += " " + std::to_string(vertex + 1);
      ele += "\n";
    }
    write_file(stem(3) + ".ele", ele);
    expect_whole();
  }
}

TEST_F(CommandPartitionTest, OnlyMissingRegionsAreSolved) {
  make("uniform", "500", "2");
  solve(1, ".npy");
  const Arguments command = {"assemble", path("points.npy"), path("p")};
  expect_error(kBadInput, {"region-00000.npy", "3 of 4", "--solve"}, command);
  expect_whole({"--solve"});
  // What is there is used, and checked.
  write_rows("p/region-00001.npy", {0, 1, 2});
  expect_error(kBadInput, {"region-00001.npy"}, {"assemble", path("points.npy"), path("p"), "--solve"});
}

TEST_F(CommandPartitionTest, WrongSolutionsAreNamed) {
  make("uniform", "300", "2");
  for (std::size_t r = 0; r < 4; ++r) solve(r, ".npy");
  const std::string file = stem(2) + ".npy";
  const Array right = read_array(file);
  const Arguments command = {"assemble", path("points.npy"), path("p"), "-o", path("mesh.off")};
  const auto wrong = [&](std::vector<std::int32_t> values) {
    write_rows("p/region-00002.npy", values);
    expect_error(kBadInput, {"region-00002.npy"}, command);
  };
  wrong({});
  wrong({right.values.begin() + 3, right.values.end()});
  std::vector<std::int32_t> beyond = right.values;
  beyond[4] = 100000;
  wrong(beyond);
  std::vector<std::int32_t> twice = right.values;
  for (std::size_t k = 0; k < 3; ++k) twice[3 + k] = twice[k];
  wrong(twice);
  write_file(file, "no array");
  expect_error(kBadInput, {"region-00002.npy"}, command);
}

TEST_F(CommandPartitionTest, TheInputMustBeThePartitionsOwn) {
  make("uniform", "300", "2");
  const auto other = [&](const std::string& count, const std::vector<std::string>& parts) {
    run_well({"generate", "uniform", count, "--seed", "2", "-o", path("other.npy")}, kNoPlatform);
    expect_error(kBadInput, parts,
                 {"assemble", path("other.npy"), path("p"), "--solve", "-o", path("mesh.off")});
  };
  other("300", {"region-00000.node", "other.npy"});
  other("301", {"other.npy", "301", "300"});
}

TEST_F(CommandPartitionTest, BrokenFilesAreNamed) {
  make("uniform", "300", "1");
  const auto description = json_of(path("p/partition.json"));
  expect_broken("p/partition.json", "{\"points\": 300,", {"JSON"});
  expect_broken("p/partition.json", "[]", {"points"});
  for (const char* key : {"points", "finished_triangles", "regions"}) {
    auto broken = description;
    broken[key] = -1;
    expect_broken("p/partition.json", broken.dump(), {key});
    broken.erase(key);
    expect_broken("p/partition.json", broken.dump(), {key});
  }
  auto more = description;
  more["regions"].push_back(more["regions"][0]);
  write_file(path("p/partition.json"), more.dump());
  expect_error(kBadInput, {"region-00002.node", "No such file"},
               {"assemble", path("points.npy"), path("p"), "--solve"});
  write_file(path("p/partition.json"), description.dump());

  const std::string node = contents(path("p/region-00001.node"));
  expect_broken("p/region-00001.node", node.substr(0, node.size() / 2), {"line"});
  expect_broken("p/region-00001.node", "1 2 1 1\n0 0.5 0.5 3 1\n", {"1 vertices"});
  expect_broken("p/region-00001.node", "1 2 0 0\n0 0.5 0.5\n", {"attribute"});
  const std::string poly = contents(path("p/region-00001.poly"));
  expect_broken("p/region-00001.poly", poly.substr(0, poly.size() / 2), {});
  expect_broken("p/region-00001.poly", "0 2 1 1\n1 0\n0 0 9999\n0\n", {"line 3", "9999"});
  expect_broken("p/region-00001.poly", "0 2 1 1\n0 0\n0\n", {"0 segments"});
  expect_broken("p/finished.npy", "no array", {});
  expect_broken("p/finished.npy", npy("<i4", "False", "(1, 3)", bytes_of<std::int32_t>({0, 1, 2})),
                {"1 triangles"});
  expect_whole({"--solve"});
  expect_error(kBadInput, {"partition.json", "No such file"},
               {"assemble", path("points.npy"), path("nowhere")});
}

TEST_F(CommandPartitionTest, NothingIsReplacedUnlessForced) {
  make("uniform", "300", "2");
  solve(0, ".npy");
  const std::vector<std::string> before = folder();
  // The input is missing and there is no device: that the folder is what is complained of shows the order.
  expect_error(kUsage, {"in the way", "--force"},
               {"partition", path("missing.npy"), "--levels", "1", "-o", path("p")});
  expect_error(kBadInput, {"missing.npy"},
               {"partition", path("missing.npy"), "--levels", "1", "-o", path("p"), "--force"});
  EXPECT_EQ(folder(), before);
  write_file(path("p/notes.txt"), "precious");
  // The solution of a region that will not be there. What it links to is no part of the partition.
  fs::create_symlink("notes.txt", path("p/region-00003.ele"));
  run_well({"partition", path("points.npy"), "--levels", "1", "-o", path("p"), "--force"});
  EXPECT_EQ(contents(path("p/notes.txt")), "precious");
  EXPECT_EQ(folder(),
            (std::vector<std::string>{"finished.npy", "notes.txt", "partition.json", "region-00000.node",
                                      "region-00000.poly", "region-00001.node", "region-00001.poly"}));
  expect_whole({"--solve"});
  const std::string region = path("p/region-00000.node");
  expect_error(kUsage, {"region-00000.node", "overwrite the input"},
               {"partition", region, "--levels", "1", "-o", path("p"), "--force"});
}

TEST_F(CommandPartitionTest, AnErrorLeavesNoFolderBehind) {
  const std::string points = write("points.xy", "0 0\n1 0\n0 1\n5 5\n");
  expect_error(kBadInput, {"missing.npy"},
               {"partition", path("missing.npy"), "--levels", "1", "-o", path("p")});
  expect_error(kDevice, {"pocl-opencl-icd"},
               {"partition", points, "--levels", "1", "-o", path("p"), "--device", "#0"});
  expect_error(kUsage, {"p.png", ".svg"},
               {"partition", points, "--levels", "1", "-o", path("p"), "--picture", path("p.png")});
  expect_error(kBadInput, {"no/such/folder"},
               {"partition", points, "--levels", "1", "-o", path("no/such/folder")});
  expect_error(kBadInput, {"points.xy"}, {"partition", points, "--levels", "1", "-o", points});
  for (const char* levels : {"-1", "31", "few"}) {
    expect_error(kUsage, {"--levels"}, {"partition", points, "--levels", levels, "-o", path("p")});
  }
  expect_error(kUsage, {"--levels"}, {"partition", points, "-o", path("p")});
  expect_error(kUsage, {"--output"}, {"partition", points, "--levels", "1"});
  expect_error(kUsage, {"--hull-variant"},
               {"partition", points, "--levels", "1", "-o", path("p"), "--hull-variant", "monotone-chain"});
  // A folder that was there stays, as it was.
  fs::create_directory(path("p"));
  expect_error(kBadInput, {"missing.npy"},
               {"partition", path("missing.npy"), "--levels", "1", "-o", path("p")});
  EXPECT_TRUE(folder().empty());
}

TEST_F(CommandPartitionTest, AssembleSaysWhatMakesNoSense) {
  make("uniform", "300", "1");
  const Arguments command = {"assemble", path("points.npy"), path("p")};
  const auto with = [&](const Arguments& more) { return joined(command, more); };
  expect_error(kUsage, {"--threads", "--solve"}, with({"--threads", "2"}));
  expect_error(kUsage, {"region-00000.ele", "overwrite the partition"},
               with({"--solve", "-o", path("p/region-00000.ele")}));
  expect_error(kUsage, {"finished.npy", "overwrite the partition"}, with({"--hull", path("p/finished.npy")}));
  expect_error(kUsage, {"overwrite the input"}, with({"--hull", path("points.npy")}));
  expect_error(kUsage, {"partition"}, {"assemble", path("points.npy")});
  EXPECT_EQ(run_well(with({"--solve", "--quiet"}), kNoPlatform).out, "");
  const Outcome outcome = run_well(with({"--solve", "--stats", path("stats.json")}), kNoPlatform);
  expect_parts(outcome.out, {"assembled on the host in"});
  const auto stats = json_of(path("stats.json"));
  EXPECT_EQ(stats.value("mode", ""), "assemble");
  EXPECT_EQ(stats.value("device", ""), "host");
}

// ---------------------------------------------------------------------------------------------- constraints

/// The coordinates in a text file of the command.
std::vector<double> read_text_points(const fs::path& path) {
  std::ifstream file(path);
  std::string header;
  std::getline(file, header);
  return {std::istream_iterator<double>(file), std::istream_iterator<double>()};
}

double area_of(const std::vector<double>& points, const Rows& triangles) {
  double area = 0;
  for (const auto& [a, b, c] : triangles) {
    const auto x = [&](std::int32_t v) { return points.at(2 * v); };
    const auto y = [&](std::int32_t v) { return points.at(2 * v + 1); };
    area += ((x(b) - x(a)) * (y(c) - y(a)) - (x(c) - x(a)) * (y(b) - y(a))) / 2;
  }
  return area;
}

class CommandConstraintsTest : public ArraysTest {
 protected:
  static constexpr const char* kMap = R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [
          [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]], [[1, 1], [1, 2], [2, 2], [2, 1], [1, 1]]]}},
      {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [
          [[4, 0], [7, 0], [7, 4], [4, 4], [4, 0]]]}}]})";

  /// The area of the triangles of a run.
  double area(const std::string& input, const Arguments& options = {}) const {
    run_well(joined({"triangulate", input, "--triangles", path("t.npy"), "--points", path("p.txt")}, options),
             kNoPlatform);
    return area_of(read_text_points(path("p.txt")), sorted_rows(path("t.npy")));
  }
};

TEST_F(CommandConstraintsTest, SegmentsBesidePointsBecomeEdges) {
  const std::string points = write("points.xy", "0 0\n4 0\n8 0\n8 1\n4 1\n0 1\n4 0.5\n");
  const std::string segments = write("s.txt", "0 2\n5 6\n2 0\n");
  const Outcome outcome =
      run_well({"triangulate", points, "--constraints", segments, "--triangles", path("t.npy"),
                "--constraint-edges", path("e.npy"), "--edge-segments", path("s.npy"), "--regions",
                path("r.npy"), "--depths", path("d.npy"), "--stats", path("stats.json")},
               kNoPlatform);
  expect_parts(outcome.out, {"3 segments, 3 constraint edges"});
  const Array edges = read_array(path("e.npy"));
  EXPECT_EQ(edges.shape, "(3, 2)");
  EXPECT_EQ(edges.values, (Indices{0, 1, 1, 2, 5, 6}));
  EXPECT_EQ(read_array(path("s.npy")).values, (Indices{0, 0, 1}));
  const std::size_t triangles = sorted_rows(path("t.npy")).size();
  EXPECT_EQ(triangles, 6U);
  EXPECT_EQ(read_array(path("r.npy")).values, std::vector<std::int32_t>(triangles, 0));
  EXPECT_EQ(read_array(path("d.npy")).shape, "(6,)");

  const auto stats = json_of(path("stats.json"));
  const nlohmann::json& constraints = stats["constraints"];
  EXPECT_EQ(constraints["segments"], 3);
  EXPECT_EQ(constraints["pieces"], 3);
  EXPECT_EQ(constraints["constraint_edges"], 3);
  EXPECT_EQ(constraints["added_points"], 0);
  EXPECT_EQ(constraints["outside"], "keep");
  EXPECT_EQ(constraints["fill"], "nesting");
  EXPECT_EQ(constraints["crossings"], "error");
  run_well({"triangulate", points, "--stats", path("stats.json")}, kNoPlatform);
  EXPECT_TRUE(json_of(path("stats.json"))["constraints"].is_null());
  // From standard input, too.
  run_well({"triangulate", "-", "--constraints", segments}, kNoPlatform, contents(points));
}

TEST_F(CommandConstraintsTest, PointsAreAddedUntilTrianglesAreGood) {
  // Two squares side by side, one of which may have larger triangles.
  const std::string poly = write("a.poly",
                                 "6 2 0 1\n0 0 0 5\n1 2 0 5\n2 4 0 5\n3 4 2 5\n4 2 2 5\n5 0 2 5\n"
                                 "7 1\n0 0 1 7\n1 1 2 7\n2 2 3 7\n3 3 4 7\n4 4 5 7\n5 5 0 7\n6 1 4 9\n0\n"
                                 "2\n0 1 1 1 0.05\n1 3 1 2 -1\n");
  const auto refine = [&](const Arguments& options) {
    return run_well(joined({"triangulate", poly, "--min-angle", "30", "--stats", path("s.json"),
                            "--vertex-markers", path("m.npy")},
                           options),
                    kNoPlatform);
  };
  const Outcome outcome =
      refine({"--max-area", "0.5", "--region-areas", "-o", path("b.ele"), "--areas", path("f.npy")});
  expect_parts(outcome.out, {"angles from 3"});
  EXPECT_EQ(outcome.out.find("worse"), std::string::npos) << outcome.out;
  const nlohmann::json stats = json_of(path("s.json")), report = stats["refinement"];
  EXPECT_GE(report["smallest_angle"], 30 - 1e-9);
  EXPECT_LE(report["largest_angle"], 120 + 1e-9);
  EXPECT_EQ(report["added_points"], stats["constraints"]["added_points"]);
  EXPECT_EQ(stats["points"], 6 + report["added_points"].get<int>());
  EXPECT_GT(report["rounds"], 0);
  EXPECT_GT(report["split_points"], 0);
  EXPECT_EQ(report["bad_triangles"]["kept"], 0);
  const Indices markers = read_array(path("m.npy")).values;
  ASSERT_EQ(markers.size(), stats["points"].get<std::size_t>());
  for (const std::int32_t marker : {7, 9, 0}) {
    EXPECT_NE(std::count(markers.begin() + 6, markers.end(), marker), 0) << marker;
  }
  EXPECT_GE(stats["triangles"], 2 / 0.05 + 2 / 0.5);

  run_well({"verify", path("b.poly"), path("b.ele"), "--min-angle", "30", "--max-area", "0.5"}, kNoPlatform);

  // What is left is said, and where the first one is.
  const Outcome kept = refine({"--max-area", "0.05", "--keep-edges", "all"});
  expect_parts(kept.out, {"at an edge that is kept; the first one is triangle "});
  const auto of_kept = json_of(path("s.json"))["refinement"];
  EXPECT_EQ(of_kept["split_points"], 0);
  EXPECT_GT(of_kept["bad_triangles"]["kept"], 0);
  const std::string far = write("far.xy", "500000 5000000\n500004 5000000\n500002 5000000.375\n");
  const Outcome there =
      run_well({"triangulate", far, "--min-angle", "30", "--keep-edges", "all"}, kNoPlatform);
  expect_parts(there.out, {" at (500002, 5000000.125)\n"});
  const Outcome few = refine({"--max-area", "0.01", "--most-points", "5"});
  expect_parts(few.out, {"for --most-points"});
  EXPECT_LE(json_of(path("s.json"))["refinement"]["added_points"], 5);
  const Outcome smooth = refine({"--max-area", "0.05", "--smooth", "3", "-o", path("b.ele")});
  expect_parts(smooth.out, {"before smoothing"});
  const auto smoothed = json_of(path("s.json"))["refinement"];
  EXPECT_GE(smoothed["mean_angle"], 30);
  EXPECT_GE(smoothed["mean_angle_before"], 30);
  EXPECT_GE(smoothed["smallest_angle_before"], 30 - 1e-9);
  run_well({"verify", path("b.poly"), path("b.ele"), "--min-angle", "30", "--max-area", "0.05"}, kNoPlatform);

  // Points alone are refined inside of their hull.
  const std::string square = write("q.xy", "0 0\n1 0\n1 1\n0 1\n");
  EXPECT_NEAR(area(square, {"--max-area", "0.01"}), 1, 1e-12);
  EXPECT_GT(sorted_rows(path("t.npy")).size(), 100U);
  run_well({"triangulate", poly, "--stats", path("s.json")}, kNoPlatform);
  EXPECT_TRUE(json_of(path("s.json"))["refinement"].is_null());

  expect_error(kUsage, {"--min-angle", "34"}, {"triangulate", poly, "--min-angle", "40"});
  expect_error(kUsage, {"--max-area"}, {"triangulate", poly, "--max-area", "-1"});
  expect_error(kUsage, {"--keep-edges", "needs --min-angle"}, {"triangulate", poly, "--keep-edges", "all"});
  expect_error(kUsage, {"--smooth", "needs --min-angle"}, {"triangulate", poly, "--smooth", "1"});
  expect_error(kUsage, {"--region-areas", ".poly"}, {"triangulate", square, "--region-areas"});
  expect_error(kUsage, {"--crossings", "needs segments"},
               {"triangulate", square, "--max-area", "1", "--crossings", "split"});
  expect_error(kUsage, {"--memory", "refinement"},
               {"triangulate", square, "--max-area", "1", "--memory", "64M"});
  expect_error(kUsage, {"no regions with areas"}, {"triangulate", data("star.poly"), "--region-areas"});
}

TEST_F(CommandConstraintsTest, MeshesAreRefinedFurther) {
  const std::string poly = data("letter.poly"), coarse = path("a.ele"), node = path("a.node");
  run_well({"triangulate", poly, "--outside", "holes", "--min-angle", "20", "-o", coarse}, kNoPlatform);
  const std::size_t triangles = std::stoul(contents(coarse));
  std::string areas = std::to_string(triangles) + "\n";
  for (std::size_t t = 1; t <= triangles; ++t) areas += std::to_string(t) + (t == 3 ? " 0.0001\n" : " -1\n");
  const Arguments again = {"triangulate", node, "--mesh", coarse, "--mesh-areas", write("a.area", areas)};
  const auto refine = [&](const Arguments& options) { return run_well(joined(again, options), kNoPlatform); };
  refine({"--min-angle", "20", "--conforming", "--points", path("p.npy"), "--triangles", path("t.npy"),
          "--constraint-edges", path("e.npy"), "--areas", path("f.npy")});
  EXPECT_GT(sorted_rows(path("t.npy")).size(), triangles + 20);
  const Arguments check = {"verify",      path("p.npy"), path("t.npy"), "--constraints",
                           path("e.npy"), "--outside",   "holes",       "--min-angle",
                           "20",          "--conforming"};
  run_well(check, kNoPlatform);
  // The mesh as it is.
  EXPECT_NEAR(area(node, {"--mesh", coarse}), area(poly, {"--outside", "holes"}), 1e-12);
  expect_error(kUsage, {"--mesh-areas", "--mesh"}, {"triangulate", node, "--mesh-areas", path("a.area")});
  expect_error(kUsage, {"--outside", "--mesh"}, {"triangulate", node, "--mesh", coarse, "--outside", "hull"});
  expect_error(kBadInput, {"1 areas"},
               {"triangulate", node, "--mesh", coarse, "--mesh-areas", write("b.area", "1\n1 2\n")});
  expect_error(kBadInput, {"line 3", "expected triangle number 2, found 3"},
               {"triangulate", node, "--mesh", coarse, "--mesh-areas", write("b.area", "2\n1 2\n3 2\n")});
  expect_error(kBadInput, {"expected an area"},
               {"triangulate", node, "--mesh", coarse, "--mesh-areas", write("b.area", "1\n1 x\n")});
}

TEST_F(CommandConstraintsTest, ALetterIsWhatTriangleMakesOfIt) {
  // The outline is a trapezium without the gap between the legs; the opening is a hole.
  const double gap = (0.52 + 0.30) / 2 * 0.28, opening = 0.16 * 0.24 / 2, trapezium = (1 + 0.24) / 2;
  const std::string letter = data("letter.poly");
  EXPECT_NEAR(area(letter), trapezium - gap - opening, 1e-12);
  EXPECT_NEAR(area(letter, {"--outside", "keep"}), trapezium - opening, 1e-12) << "holes are holes";
  EXPECT_NEAR(area(letter, {"--hole", "0.05,0.05"}), 0, 1e-12);
  EXPECT_EQ(read_text_points(path("p.txt")).size(), 30U);
  const Outcome outcome = run_well({"triangulate", letter, "--hole", "0.05,0.05"}, kNoPlatform);
  expect_parts(outcome.out, {"no triangles"});
}

TEST_F(CommandConstraintsTest, TrianglesHaveTheAttributesOfTheirRegionsAndMarkersAreKept) {
  // Two squares side by side, and a segment across both, which is split at their common side. Of the regions
  // one has none, one has two, of which the last counts.
  const std::string drawing =
      "6 2 0 1\n0 0 0 7\n1 4 0 0\n2 4 4 0\n3 0 4 0\n4 8 0 9\n5 8 4 0\n"
      "8 1\n0 0 1 1\n1 1 2 20\n2 2 3 3\n3 3 0 4\n4 1 4 5\n5 4 5 6\n6 5 2\n7 0 5 10\n0\n";
  const std::string poly = write("a.poly", drawing + "3\n0 2 3 1.5 0.1\n1 5 1 -2\n2 7 0.5 2.5\n");
  for (const auto& [place, what] : {std::pair("4 1", "on a constraint"), {"20 20", "in no triangle"}}) {
    expect_error(
        kBadInput, {"seed 0", what},
        {"triangulate", write("bad.poly", drawing + "1\n0 " + place + " 9\n"), "--crossings", "split"});
  }
  const Outcome outcome =
      run_well({"triangulate", poly, "--crossings", "split", "-o", path("b.ele")}, kNoPlatform);
  EXPECT_EQ(outcome.out.find("note"), std::string::npos) << outcome.out;
  run_well({"triangulate", poly, "--crossings", "split", "--edge-markers", path("e.npy"), "--vertex-markers",
            path("v.npy"), "--triangle-attributes", path("a.npy"), "--constraint-edges", path("c.npy")},
           kNoPlatform);
  EXPECT_EQ(read_array(path("v.npy")).values, (Indices{7, 0, 0, 0, 9, 0, 20}))
      << "the common side has the smaller number";
  // In each square, one of the region and one of none, on two sides of the segment.
  expect_parts(contents(path("b.ele")), {"6 3 3\n", " 1.5 ", " 2.5 ", " 0 "});
  const std::string doubles = contents(path("a.npy"));
  expect_parts(doubles, {"'<f8', 'fortran_order': False, 'shape': (6,)"});
  const Array edges = read_array(path("c.npy")), edge_marks = read_array(path("e.npy"));
  for (std::size_t e = 0; e < edge_marks.values.size(); ++e) {
    if (edges.values.at(2 * e) == 0 && edges.values.at(2 * e + 1) == 1) {
      EXPECT_EQ(edge_marks.values[e], 1);
    }
  }
  const std::string star = data("star.poly");
  for (const auto& [option, what] : {std::pair("--edge-markers", "markers of segments"),
                                     std::pair("--vertex-markers", "markers of points"),
                                     std::pair("--triangle-attributes", "regions with attributes")}) {
    expect_error(kUsage, {what, option}, {"triangulate", star, option, path("e.npy")});
  }
  const std::string segments = contents(path("b.poly"));
  expect_parts(segments, {" 20\n", "\n3\n0 2 3 1.5 0.1\n1 5 1 -2\n"});
}

TEST_F(CommandConstraintsTest, AMapHasItsPolygonsAndKnowsThem) {
  const std::string map = write("map.geojson", kMap);
  EXPECT_DOUBLE_EQ(area(map, {"--polygons", path("q.npy"), "--depths", path("d.npy")}), 15 + 12);
  const std::vector<double> points = read_text_points(path("p.txt"));
  EXPECT_EQ(points.size(), 2U * 12);
  const Array triangles = read_array(path("t.npy")), polygons = read_array(path("q.npy"));
  ASSERT_EQ(3 * polygons.values.size(), triangles.values.size());
  for (std::size_t t = 0; t < polygons.values.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const double x = points.at(2 * triangles.values[3 * t + k]);
      EXPECT_TRUE(polygons.values[t] == 0 ? x <= 4 : x >= 4) << t;
    }
  }
  EXPECT_DOUBLE_EQ(area(map, {"--outside", "keep"}), 28);
  EXPECT_DOUBLE_EQ(area(map, {"--fill", "even-odd"}), 27);
  EXPECT_DOUBLE_EQ(area(map, {"--hole", "5,1"}), 15);
  // Their borders are the same edges in one map, and edges of each in two sets.
  const Outcome together = run_well({"triangulate", map}, kNoPlatform);
  expect_parts(together.out, {"12 segments, 11 constraint edges"});
  const Outcome separate =
      run_well({"triangulate", map, "--separate", "--polygons", path("q.npy")}, kNoPlatform);
  expect_parts(separate.out, {"12 segments, 12 constraint edges, 2 sets"});
  EXPECT_EQ(read_array(path("q.npy")).values, (Indices{0, 0, 0, 0, 0, 0, 0, 0, 1, 1}));
}

// The z of the points of a file .obj.
std::vector<double> heights_of(const std::string& obj) {
  std::vector<double> heights;
  std::istringstream lines(obj);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("v ")) heights.push_back(std::stod(line.substr(line.rfind(' '))));
  }
  return heights;
}

TEST_F(CommandConstraintsTest, MeshesInSpaceHaveTheHeightsOfTheInput) {
  const std::string text = write("a.csv", "id;e;n;h\n1;0;0;1,5\n2;2;0;2\n3;0;2;3\n");
  Outcome outcome = run_well({"triangulate", text, "--columns", "e,n,h", "-o", path("a.obj")});
  EXPECT_EQ(heights_of(contents(path("a.obj"))), (std::vector<double>{1.5, 2, 3}));
  expect_parts(outcome.out, {"third number"});
  outcome = run_well({"triangulate", text, "--columns", "1,2,3", "-o", path("a.ele")});
  expect_parts(outcome.out, {"a.csv has heights, which"});
  EXPECT_EQ(run_well({"triangulate", text, "--columns", "e,n", "-o", path("a.ele")}).out.find("height"),
            std::string::npos);
  run_well({"verify", text, path("a.ele"), "--columns", "e,n"});

  const std::vector<double> scan = [&] {
    run_well({"triangulate", data("garden.las"), "-o", path("g.obj"), "--device", "host"});
    return heights_of(contents(path("g.obj")));
  }();
  const auto [low, high] = std::minmax_element(scan.begin(), scan.end());
  EXPECT_TRUE(1353 < *low && *low < 1356 && 1390 < *high && *high < 1405) << *low << " to " << *high;

  // Rows are those of the file, also where it marks points as withheld, which is told.
  std::string las = contents(data("garden.las"));
  const auto number_at = [&las](std::size_t at, std::size_t bytes) {
    std::size_t number = 0;
    std::memcpy(&number, &las[at], bytes);
    return number;
  };
  const std::size_t begin = number_at(96, 4), record = number_at(105, 2);
  for (const std::size_t k : {0, 7})
    las[begin + k * record + 15] |= static_cast<char>(las[104] < 6 ? 0x80 : 4);
  write_file(path("withheld.las"), las);
  outcome = run_well({"triangulate", path("withheld.las"), "-o", path("w.obj"), "--device", "host"});
  expect_parts(outcome.out, {"withheld.las marks 2 points as withheld"});
  EXPECT_EQ(contents(path("w.obj")), contents(path("g.obj")));

  // Heights of points that are added: on a segment those of its line, elsewhere of the triangles.
  const std::string plane = write("plane.geojson", R"({"type": "MultiLineString", "coordinates":
      [[[0,0,0],[4,0,4],[4,4],[0,4,8]], [[0,1,0],[4,3,6]], [[1,0,1],[1,4,9]]]})");
  outcome = run_well({"triangulate", plane, "--crossings", "split", "--max-area", "0.5", "-o", path("p.obj"),
                      "--points", path("p.txt")});
  const std::vector<double> points = read_text_points(path("p.txt"));
  const std::vector<double> found = heights_of(contents(path("p.obj")));
  ASSERT_EQ(2 * found.size(), points.size());
  ASSERT_GT(found.size(), 20U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = points[2 * i], y = points[2 * i + 1];
    if (x == 1 && y != 1.5) {
      EXPECT_DOUBLE_EQ(found[i], 1 + 2 * y);
    }
    if (y == 1 + x / 2) {
      EXPECT_NEAR(found[i], 1.5 * x, 1e-12) << "the line that comes first";
    }
    if (x == 4 && y == 4) {
      EXPECT_EQ(found[i], 6) << "beyond all heights, that of the nearest one";
    }
    EXPECT_TRUE(found[i] >= 0 && found[i] <= 9) << found[i];
  }
}

TEST_F(CommandConstraintsTest, TrianglesHaveThePropertiesOfTheirPolygons) {
  const std::string polygons = R"({"type": "FeatureCollection", "features": [
      {"type": "Feature", "properties": {"name": "A"}, "geometry":
       {"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,4],[0,4],[0,0]]]}},
      {"type": "Feature", "properties": {"name": "B"}, "geometry":
       {"type": "Polygon", "coordinates": [[[4,0],[8,0],[4,4],[4,0]]]}}]})";
  const std::string map = write("map.geojson", polygons);
  run_well({"triangulate", map, "-o", path("out.geojson")}, kNoPlatform);
  const auto features = json_of(path("out.geojson"))["features"];
  ASSERT_EQ(features.size(), 3U);
  for (const auto& feature : features) {
    const auto& properties = feature["properties"];
    double most = 0;
    for (const auto& corner : feature["geometry"]["coordinates"][0])
      most = std::max(most, corner[0].get<double>());
    EXPECT_EQ(properties["name"], most > 4 ? "B" : "A");
    EXPECT_EQ(properties["polygon"], most > 4 ? 1 : 0);
  }
  const Outcome outcome =
      run_well({"triangulate", map, "--hole", "1,1", "-o", path("out.geojson")}, kNoPlatform);
  expect_parts(outcome.out, {"no properties of polygons"});
}

TEST_F(CommandConstraintsTest, RingsMayHaveAnyDirection) {
  const std::string border = "[[0,0],[10,0],[10,10],[0,10],[0,0]]", hole = "[[3,3],[7,3],[7,7],[3,7],[3,3]]";
  const std::string with_hole = R"({"type": "Polygon", "coordinates": [)" + border + "," + hole + "]}",
                    parts = R"({"type": "MultiPolygon", "coordinates": [[)" + border + "],[" + hole + "]]}";
  for (const auto& [shape, expected] : {std::pair(with_hole, 84), std::pair(parts, 100)}) {
    const std::string map = write("map.geojson", shape),
                      mixed = write("mixed.geojson",
                                    R"({"type": "GeometryCollection", "geometries": [)" + shape +
                                        R"(, {"type": "LineString", "coordinates": [[-1, -1], [-1, 11]]}]})");
    for (const Arguments& options : {Arguments{"--fill", "winding"}, Arguments{"--fill", "even-odd"},
                                     Arguments{"--fill", "winding", "--separate"}}) {
      for (const std::string& input : options.size() == 2 ? std::vector{map, mixed} : std::vector{map}) {
        EXPECT_DOUBLE_EQ(area(input, joined(options, {"--depths", path("d.npy")})), expected) << input;
        const Indices depths = read_array(path("d.npy")).values;
        EXPECT_EQ(depths, std::vector<std::int32_t>(depths.size(), 1));
        run_well({"verify", input, path("t.npy"), "--fill", options[1]}, kNoPlatform);
      }
    }
  }
}

// As flaunay.polygons in Python does (test_polygons.py).
TEST_F(CommandConstraintsTest, WhatPolygonsGoAroundTwiceIsNotInThem) {
  const std::string twice = write("twice.geojson", R"({"type": "Polygon", "coordinates": [[[0, 0], [6, 0],
      [6, 6], [1, 6], [1, 1], [5, 1], [5, 5], [0, 5], [0, 0]]]})");
  const Arguments split = {"--crossings", "split"};
  EXPECT_DOUBLE_EQ(area(twice, split), 19);
  EXPECT_DOUBLE_EQ(area(twice, joined(split, {"--fill", "even-odd"})), 19);
  EXPECT_DOUBLE_EQ(area(twice, joined(split, {"--fill", "winding"})), 35);
}

TEST_F(CommandConstraintsTest, LinesAndPointsBesidePolygonsAreInTheirMesh) {
  const double meadow_and_orchard = area(data("parcels.geojson"));
  EXPECT_GT(meadow_and_orchard, 6000);
  EXPECT_LT(meadow_and_orchard, area(data("parcels.geojson"), {"--outside", "keep"}));
  EXPECT_DOUBLE_EQ(meadow_and_orchard, area(data("parcels.geojson"), {"--fill", "even-odd"}));
  const Outcome outcome = run_well({"triangulate", data("parcels.geojson")}, kNoPlatform);
  expect_parts(outcome.out, {"30 points, 5 duplicates", "26 segments, 24 constraint edges"});
  for (const Arguments& options : {Arguments{"--separate"}, Arguments{"--polygons", path("q.npy")}}) {
    Arguments arguments = {"triangulate", data("parcels.geojson")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_error(kUsage, {"parcels.geojson", "polygons alone"}, arguments);
  }
}

TEST_F(CommandConstraintsTest, OverlapsBelongToTheFirstPolygonUnlessTheyAreErrors) {
  const std::string map = write("map.json",
                                R"({"type": "GeometryCollection", "geometries": [
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]},
      {"type": "Polygon", "coordinates": [[[1, 1], [2, 1], [2, 2], [1, 2], [1, 1]]]}]})");
  EXPECT_DOUBLE_EQ(area(map, {"--depths", path("d.npy"), "--polygons", path("q.npy")}), 16);
  const Array depths = read_array(path("d.npy")), polygons = read_array(path("q.npy"));
  EXPECT_EQ(std::count(depths.values.begin(), depths.values.end(), 2), 2);
  EXPECT_EQ(std::count(polygons.values.begin(), polygons.values.end(), 0),
            static_cast<std::ptrdiff_t>(polygons.values.size()));
  expect_error(kBadInput, {"map.json", "polygons 0 and 1 overlap"},
               {"triangulate", map, "--overlaps", "error"});
}

TEST_F(CommandConstraintsTest, CrossingSegmentsAreSplitIfThatIsAskedFor) {
  const std::string cross = write("cross.xy", "0 0\n4 0\n4 4\n0 4\n");
  const std::string diagonals = write("s.txt", "0 2\n1 3\n");
  const Outcome outcome =
      run_well({"triangulate", cross, "--constraints", diagonals, "--crossings", "split", "--points",
                path("p.txt"), "--constraint-edges", path("e.npy"), "--edge-segments", path("s.npy"),
                "--stats", path("stats.json"), "-o", path("a.svg"), "--triangles", path("t.npy")},
               kNoPlatform);
  expect_parts(outcome.out, {"4 constraint edges, 1 added point;"});
  EXPECT_EQ(read_text_points(path("p.txt")), (std::vector<double>{0, 0, 4, 0, 4, 4, 0, 4, 2, 2}));
  EXPECT_EQ(sorted_rows(path("t.npy")), (Rows{{0, 1, 4}, {0, 4, 3}, {1, 2, 4}, {2, 3, 4}}));
  EXPECT_EQ(read_array(path("e.npy")).shape, "(4, 2)");
  EXPECT_EQ(read_array(path("s.npy")).shape, "(4,)");
  const auto constraints = json_of(path("stats.json"))["constraints"];
  EXPECT_EQ(constraints["pieces"], 4);
  EXPECT_EQ(constraints["added_points"], 1);
  EXPECT_EQ(constraints["crossings"], "split");
  EXPECT_NE(contents(path("a.svg")).find("1 point added<"), std::string::npos);
  // Borders that cross, and a line across a polygon, whose two directions are split at the same points.
  const std::string map = write("map.json", R"({"type": "GeometryCollection", "geometries": [
      {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 4], [0, 0]]]},
      {"type": "LineString", "coordinates": [[-1, 1], [5, 3]]},
      {"type": "Polygon", "coordinates": [[[2, 2], [6, 2], [6, 6], [2, 6], [2, 2]]]}]})");
  EXPECT_DOUBLE_EQ(area(map, {"--crossings", "split"}), 16 + 16 - 4);
  EXPECT_DOUBLE_EQ(area(map, {"--crossings", "split", "--fill", "even-odd"}), 16 + 16 - 4);
}

TEST_F(CommandConstraintsTest, MeshesCanBeReadAgain) {
  run_well({"triangulate", data("letter.poly"), "-o", path("a.ele"), "--outside", "keep", "--quiet"},
           kNoPlatform);
  EXPECT_EQ(files(), (std::vector<std::string>{"a.ele", "a.node", "a.poly"}));
  const double once = area(path("a.poly"), {"--outside", "keep", "--constraint-edges", path("e.npy")});
  EXPECT_DOUBLE_EQ(once, area(data("letter.poly"), {"--outside", "keep"}));
  EXPECT_EQ(read_array(path("e.npy")).shape, "(12, 2)");
  for (const char* name : {"a.off", "a.ply", "a.obj", "a.msh", "a.vtu", "a.npy", "a.geojson", "a.svg"}) {
    run_well({"triangulate", path("a.poly"), "-o", path(name), "--quiet"}, kNoPlatform);
  }
}

TEST_F(CommandConstraintsTest, InputsAreNotOverwritten) {
  write("a.node", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n");
  const std::string poly = write("a.poly", "0 2 0 0\n1 0\n0 0 1\n0\n");
  expect_error(kUsage, {"overwrite the input"}, {"triangulate", poly, "-o", path("a.ele")});
  expect_error(kUsage, {"overwrite the input"}, {"triangulate", poly, "--points", path("a.node")});
  const std::string points = write("p.xy", "0 0\n1 0\n0 1\n"), segments = path("s.npy");
  write_rows("s.npy", {0, 1}, 2);
  run_well({"triangulate", points, "--constraints", segments}, kNoPlatform);
  expect_error(kUsage, {"s.npy", "overwrite the input"},
               {"triangulate", points, "--constraints", segments, "--hull", segments});
  expect_error(kUsage, {"two outputs"},
               {"triangulate", points, "--constraints", segments, "--depths", path("d.npy"), "--regions",
                path("d.npy")});
}

TEST_F(CommandConstraintsTest, OptionsThatMakeNoSenseAreRefusedFirst) {
  const auto refused = [this](const std::string& input, const std::vector<std::string>& parts,
                              const Arguments& options) {
    expect_error(kUsage, parts, joined({"triangulate", path(input)}, options));
  };
  for (const Arguments& options :
       {Arguments{"--outside", "hull"}, Arguments{"--crossings", "split"}, Arguments{"--fill", "winding"},
        Arguments{"--hole", "1,2"}, Arguments{"--separate"}, Arguments{"--overlaps", "error"},
        Arguments{"--depths", path("d.npy")}, Arguments{"--points", path("p.npy")},
        Arguments{"--constraint-edges", path("e.npy")}}) {
    refused("missing.xy", {options[0], "needs segments"}, options);
  }
  refused("missing.poly", {"--constraints", "segments of its own"}, {"--constraints", path("s.npy")});
  refused("missing.xy", {"s.obj", ".npy, .txt, .csv"}, {"--constraints", path("s.obj")});
  refused("missing.poly", {"--separate", ".geojson"}, {"--separate"});
  refused("missing.geojson", {"--hole", "polygon"}, {"--separate", "--hole", "1,2"});
  refused("missing.geojson", {"--overlaps"}, {"--separate", "--overlaps", "error"});
  refused("missing.poly", {"--hole", "'1;2'", "X,Y"}, {"--hole", "1;2"});
  refused("missing.poly", {"--hole", "finite"}, {"--hole", "1,nan"});
  refused("missing.poly", {"--outside", "sideways"}, {"--outside", "sideways"});
  refused("missing.poly", {"--mode", "blocks"}, {"--mode", "dwyer"});
  refused("missing.poly", {"--memory", "chunks"}, {"--memory", "4G"});
  refused("missing.poly", {"--chunk-points", "chunks"}, {"--chunk-points", "4000"});
  refused("missing.poly", {"--device", "one device"}, {"--device", "host,host"});
  refused("missing.poly", {"d.txt", ".npy"}, {"--depths", path("d.txt")});
}

TEST_F(CommandConstraintsTest, FilesWithErrorsAreNamed) {
  const std::string points = write("points.xy", "0 0\n4 0\n4 4\n0 4\n");
  const auto named = [this](const std::vector<std::string>& parts, const Arguments& arguments) {
    expect_error(kBadInput, parts, joined({"triangulate"}, arguments));
  };
  named({"s.txt", "segments 0 (points 0 and 2) and 1 (points 1 and 3) cross", "(2, 2)"},
        {points, "--constraints", write("s.txt", "0 2\n1 3\n")});
  named({"none.npy", "No such file"}, {points, "--constraints", path("none.npy")});
  named({"hole.poly", "hole 0", "in no triangle"},
        {write("hole.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n0\n1\n0 5 5\n")});
  named({"open.poly", "no closed curves at point 0"},
        {write("open.poly", "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n1\n0 0 1\n0\n"), "--fill", "even-odd"});
  named({"a.geojson", "coordinates[0][1] is [1]"},
        {write("a.geojson", R"({"type": "Polygon", "coordinates": [[[0, 0], [1], [0, 1], [0, 0]]]})")});
}

}  // namespace
