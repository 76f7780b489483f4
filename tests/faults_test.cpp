// The command on systems that fail: signals, full disks, limits, renames that fail halfway. Outputs are all
// written or all left as they were, and nothing else is left behind. tests/support/faults.c makes the faults.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>
#include <string>
#include <vector>

#include "tests/support/command.hpp"

namespace {

using namespace flaunay::command;

class CommandFaultsTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("points.xy", "0 0\n4 0\n4 3\n0 4\n");
  }

  static Environment with(const std::string& faults, Environment environment = kNoPlatform) {
    environment["LD_PRELOAD"] = FLAUNAY_FAULTS_LIBRARY;
    environment["FLAUNAY_FAULTS"] = faults;
    return environment;
  }

  /// Of all files in the folder and its folders.
  std::map<std::string, std::string> everything() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(path(""))) {
      all[entry.path().string()] = entry.is_directory() ? "folder" : contents(entry.path());
    }
    return all;
  }

  /// Writes one file that is there already, and others that are not.
  Arguments triangulate() const {
    return {"triangulate",    path("points.xy"), "--mode",      "dwyer",  "-o",
            path("mesh.ele"), "--triangles",     path("t.npy"), "--hull", path("h.npy")};
  }

  /// Expects this one error, and that everything is as it was.
  void expect_unchanged(const std::vector<std::string>& parts, const Arguments& arguments,
                        const Environment& environment) const {
    const auto before = everything();
    expect_error(kBadInput, parts, arguments, environment);
    EXPECT_EQ(everything(), before);
  }
};

TEST_F(CommandFaultsTest, SignalsLeaveNothingBehind) {
  write("t.npy", "precious");
  const auto before = everything();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(signal);
    const Outcome outcome = run(triangulate(), with("end-at-sync=" + std::to_string(signal)));
    EXPECT_EQ(outcome.signal, signal) << outcome.err;
    EXPECT_EQ(everything(), before);
  }
}

TEST_F(CommandFaultsTest, WorksWithoutThreads) {
  run_well({"generate", "uniform", "20000", "-o", path("points.npy")}, kNoPlatform);
  const Arguments all = {"triangulate", path("points.npy"), "--device", "host", "--triangles", path("t.npy")};
  run_well(all, kNoPlatform);
  const std::string expected = contents(path("t.npy"));
  write("t.npy", "");
  run_well(all, with("no-threads"));
  EXPECT_EQ(contents(path("t.npy")), expected);
  run_well({"verify", path("points.npy"), path("t.npy")}, with("no-threads"));
  Arguments in_chunks = all;
  in_chunks.insert(in_chunks.end(), {"--chunk-points", "5000"});
  expect_error(kDevice, {"no thread"}, in_chunks, with("no-threads"));
  EXPECT_EQ(contents(path("t.npy")), expected);
}

TEST_F(CommandFaultsTest, WhatAKilledRunLeavesIsInNobodysWay) {
  write("t.npy", "precious");
  EXPECT_EQ(run(triangulate(), with("end-at-sync=" + std::to_string(SIGKILL))).signal, SIGKILL);
  EXPECT_EQ(contents(path("t.npy")), "precious");
  const std::vector<std::string> left = files();
  const auto is_partial = [](const std::string& name) { return fs::path(name).extension() == ".partial"; };
  EXPECT_EQ(std::count_if(left.begin(), left.end(), is_partial), 4);
  EXPECT_EQ(left.size(), 6U) << "with points.xy and t.npy";
  run_well(triangulate(), kNoPlatform);
  const std::vector<std::string> more = files();
  EXPECT_TRUE(std::includes(more.begin(), more.end(), left.begin(), left.end()));
  EXPECT_EQ(more.size(), 9U) << "with mesh.ele, mesh.node and h.npy";
}

TEST_F(CommandFaultsTest, AnIgnoredSignalStaysIgnored) {
  const Outcome outcome =
      run_script("trap '' HUP; \"$FLAUNAY\" triangulate points.xy --mode dwyer --quiet -o mesh.off",
                 with("end-at-sync=" + std::to_string(SIGHUP)));
  EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"mesh.off", "points.xy"}));
}

TEST_F(CommandFaultsTest, EverySystemReplacesFiles) {
  run_well(triangulate(), kNoPlatform);
  const auto expected = everything();
  for (const char* faults : {"", "no-links"}) {
    SCOPED_TRACE(faults);
    write("mesh.ele", "old");
    write("h.npy", "old");
    fs::remove(path("t.npy"));
    run_well(triangulate(), with(faults));
    EXPECT_EQ(everything(), expected);
  }
}

TEST_F(CommandFaultsTest, IfOneOutputCannotBePlacedAllStayAsTheyWere) {
  for (const std::string name : {"mesh.ele", "mesh.node", "t.npy", "h.npy"}) {
    for (const std::string old : {"mesh.ele", "t.npy", "h.npy"}) {
      for (const char* system : {"", ",no-links"}) {
        if (name == old && *system != '\0') continue;  // Then putting it back fails, too.
        SCOPED_TRACE(name + system + " with an old " + old);
        write(old, "precious");
        expect_unchanged({name, "Input/output error", "all outputs are as they were"}, triangulate(),
                         with("fail-renames-to=" + name + system));
        fs::remove(path(old));
      }
    }
  }
}

TEST_F(CommandFaultsTest, WhatCannotBePutBackIsSaid) {
  write("mesh.ele", "precious");
  // The first rename replaces the old file.
  const Outcome outcome = run(triangulate(), with("fail-renames-from=2"));
  EXPECT_EQ(outcome.exit_code, kBadInput);
  const std::string said = path("mesh.ele") + " could not be put back: the old file is ";
  const std::size_t at = outcome.err.find(said);
  ASSERT_NE(at, std::string::npos) << outcome.err;
  std::string old = outcome.err.substr(at + said.size());
  old.pop_back();
  EXPECT_EQ(contents(old), "precious");
  EXPECT_NE(contents(path("mesh.ele")), "precious");
  EXPECT_EQ(files().size(), 3U) << "points.xy and these two";
}

TEST_F(CommandFaultsTest, AFullDiskLeavesOldOutputs) {
  write("t.npy", "precious");
  expect_unchanged({"mesh.ele", "No space left on device"}, triangulate(), with("full-at-sync"));
}

TEST_F(CommandFaultsTest, AFullFileSystemLeavesOldOutputs) {
  const std::string mounted = "mkdir disk && mount -t tmpfs -o size=64k none disk";
  if (run_script("unshare --mount sh -c '" + mounted + "'").exit_code != 0) {
    GTEST_SKIP() << "file systems cannot be mounted here";
  }
  fs::remove(path("disk"));
  const Outcome outcome = run_script("unshare --mount sh -c '" + mounted +
                                     " && echo precious > disk/t.npy"
                                     " && \"$FLAUNAY\" generate uniform 3000 -o points.npy"
                                     " && { \"$FLAUNAY\" triangulate points.npy --mode dwyer --quiet --hull "
                                     "disk/h.npy --triangles disk/t.npy;"
                                     " echo $?; ls -A disk; cat disk/t.npy; }'");
  EXPECT_EQ(outcome.out, "3\nt.npy\nprecious\n");
  EXPECT_EQ(outcome.err, "flaunay: disk/t.npy: cannot be written: No space left on device\n");
}

TEST_F(CommandFaultsTest, ALimitOfTheSizeOfFilesIsAnError) {
  write("points.npy", "precious");
  const auto before = everything();
  const Outcome outcome = run_script("ulimit -f 8; exec \"$FLAUNAY\" generate uniform 10000 -o points.npy");
  EXPECT_EQ(outcome.exit_code, kBadInput) << "signal " << outcome.signal;
  EXPECT_EQ(outcome.err, "flaunay: points.npy: cannot be written: File too large\n");
  EXPECT_EQ(everything(), before);
}

TEST_F(CommandFaultsTest, AFolderThatCannotBeWrittenIsAnError) {
  fs::create_directory(path("closed"));
  write("closed/t.npy", "precious");
  for (const std::string& name : {std::string("closed"), std::string("..")}) {
    fs::permissions(path(name), fs::perms(0555));
  }
  fs::permissions(path("closed/t.npy"), fs::perms(0666));
  const auto before = everything();
  // Root may write everywhere.
  const std::string as_user = geteuid() == 0 ? "setpriv --reuid=65534 --clear-groups " : "";
  for (const char* name : {"closed/t.npy", "closed/new.npy"}) {
    const Outcome outcome = run_script(
        as_user + "\"$FLAUNAY\" triangulate points.xy --mode dwyer --triangles " + std::string(name));
    EXPECT_EQ(outcome.exit_code, kBadInput);
    EXPECT_EQ(outcome.err, "flaunay: " + std::string(name) +
                               ": cannot be created in folder 'closed/': Permission denied\n");
  }
  EXPECT_EQ(everything(), before);
  for (const std::string& name : {std::string("closed"), std::string("..")}) {
    fs::permissions(path(name), fs::perms(0755));
  }
}

TEST_F(CommandFaultsTest, NamesThatDifferInCaseMayBeOneFile) {
  const Arguments both = {"triangulate", path("points.xy"), "--mode", "dwyer",
                          "--triangles", path("new.npy"),   "--hull", path("NEW.npy")};
  expect_error(kUsage, {"NEW.npy", "same path"}, both, with("ignore-case"));
  EXPECT_EQ(files(), (std::vector<std::string>{"points.xy"}));
  run_well(both, kNoPlatform);
  EXPECT_EQ(files(), (std::vector<std::string>{"NEW.npy", "new.npy", "points.xy"}));
}

// ------------------------------------------------------------------------------------------------- chunks

class ChunkFaultsTest : public CommandFaultsTest {
 protected:
  void SetUp() override {
    CommandFaultsTest::SetUp();
    run_well({"generate", "uniform", "1000", "-o", path("points.npy")}, kNoPlatform);
    write("t.npy", "precious");
    fs::create_directory(path("scratch"));
  }
  Arguments in_chunks(const Arguments& options) const {
    Arguments all = {"triangulate",   path("points.npy"), "--device",    "host",        "--scratch",
                     path("scratch"), "--triangles",      path("t.npy"), "--neighbors", path("n.npy")};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }
};

TEST_F(ChunkFaultsTest, SignalsLeaveNothingBehind) {
  const auto before = everything();
  for (const char* system : {"", ",no-unnamed-files"}) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      SCOPED_TRACE(std::to_string(signal) + system);
      const Outcome outcome = run(in_chunks({"--chunk-points", "100"}),
                                  with("end-at-sync=" + std::to_string(signal) + std::string(system)));
      EXPECT_EQ(outcome.signal, signal) << outcome.err;
      EXPECT_EQ(everything(), before);
    }
  }
}

TEST_F(ChunkFaultsTest, SystemsWithoutUnnamedFiles) {
  run_well(in_chunks({"--chunk-points", "100"}), with("no-unnamed-files"));
  run_well({"verify", path("points.npy"), path("t.npy"), "--neighbors", path("n.npy")}, kNoPlatform);
  EXPECT_TRUE(fs::is_empty(path("scratch")));
}

TEST_F(ChunkFaultsTest, TheyAreChosenIfThePointsDoNotFit) {
  run_well({"generate", "uniform", "1000000", "-o", path("points.npy")}, kNoPlatform);
  const Outcome outcome =
      run_well({"triangulate", path("points.npy"), "--device", "#0", "--scratch", path("scratch"),
                "--triangles", path("t.npy")},
               {{"LD_PRELOAD", FLAUNAY_POOR_DEVICE_LIBRARY}, {"POOR_DEVICE", "buffer=50000000"}});
  expect_parts(outcome.out, {"note: about 1000000 points are too many at once: ", " chunks"});
  run_well({"verify", path("points.npy"), path("t.npy")}, kNoPlatform);
}

TEST_F(ChunkFaultsTest, AFullDiskLeavesOldOutputs) {
  expect_unchanged({"t.npy", "No space left on device"}, in_chunks({"--memory", "1G"}), with("full-at-sync"));
}

TEST_F(ChunkFaultsTest, AFullDiskInTheMiddleLeavesOldOutputs) {
  const auto before = everything();
  // 36 bytes per point: more than the scratch file has, and fewer than triangles of int64.
  const std::string command =
      "\"$FLAUNAY\" triangulate points.npy --device host --scratch scratch --triangles t.npy --memory 1G "
      "--index 64";
  const Outcome results = run_script("ulimit -f 70; exec " + command);
  EXPECT_EQ(results.exit_code, kBadInput) << "signal " << results.signal;
  EXPECT_EQ(results.err, "flaunay: t.npy: cannot be written: File too large\n");
  EXPECT_EQ(everything(), before);
  const Outcome scratch = run_script("ulimit -f 8; exec " + command);
  EXPECT_EQ(scratch.exit_code, kBadInput) << "signal " << scratch.signal;
  EXPECT_NE(scratch.err.find("File too large"), std::string::npos) << scratch.err;
  EXPECT_EQ(everything(), before);
}

TEST_F(ChunkFaultsTest, ADiskThatIsTooSmallIsFoundFirst) {
  const std::string mounted = "mkdir disk && mount -t tmpfs -o size=64k none disk";
  if (run_script("unshare --mount sh -c '" + mounted + "'").exit_code != 0) {
    GTEST_SKIP() << "file systems cannot be mounted here";
  }
  fs::remove(path("disk"));
  const auto before = everything();
  const Outcome outcome =
      run_script("unshare --mount sh -c '" + mounted +
                 " && { \"$FLAUNAY\" triangulate points.npy --memory 1G --index 64 --triangles disk/t.npy "
                 "--neighbors disk/n.npy; echo $?; ls -A disk; }'; rmdir disk");
  EXPECT_EQ(outcome.out, "3\n");
  EXPECT_EQ(
      outcome.err,
      "flaunay: disk/t.npy: the disk of 'disk/' has room for 64.0 KiB, but the outputs need 93.8 KiB\n");
  EXPECT_EQ(everything(), before);
}

TEST_F(ChunkFaultsTest, AScratchFolderThatIsTooSmallIsNamed) {
  const std::string mounted = "mkdir disk && mount -t tmpfs -o size=16k none disk";
  if (run_script("unshare --mount sh -c '" + mounted + "'").exit_code != 0) {
    GTEST_SKIP() << "file systems cannot be mounted here";
  }
  fs::remove(path("disk"));
  const auto before = everything();
  const std::string needs =
      "has room for 16.0 KiB, but the scratch file needs 23.4 KiB; name another scratch folder\n";
  for (const auto& [arguments, said] :
       {std::pair{"--scratch disk --triangles t.npy", "disk: " + needs},
        std::pair{"--scratch disk/", "disk/: " + needs},
        std::pair{
            "--scratch disk --hull disk/h.npy --triangles disk/t.npy",
            std::string("disk/t.npy: the disk of 'disk/' has room for 16.0 KiB, but the outputs and the "
                        "scratch file need 46.9 KiB\n")}}) {
    const Outcome outcome =
        run_script("unshare --mount sh -c '" + mounted +
                   " && { \"$FLAUNAY\" triangulate points.npy --device host --memory 1G --index 32 " +
                   arguments + "; echo $?; ls -A disk; }'; rmdir disk");
    EXPECT_EQ(outcome.out, "3\n");
    EXPECT_EQ(outcome.err, "flaunay: " + said);
    EXPECT_EQ(everything(), before);
  }
  const Outcome none = run_script(
      "TMPDIR=/nowhere \"$FLAUNAY\" triangulate points.npy --device host --memory 1G --triangles t.npy");
  EXPECT_EQ(none.exit_code, kBadInput);
  EXPECT_EQ(none.err, "flaunay: /nowhere: has no room for a scratch file: No such file or directory\n");
}

// ---------------------------------------------------------------------------------------------- partition

class PartitionFaultsTest : public CommandFaultsTest {
 protected:
  void SetUp() override {
    CommandFaultsTest::SetUp();
    run_well({"generate", "uniform", "300", "-o", path("points.npy")}, kNoPlatform);
    run_well({"partition", path("points.npy"), "--levels", "1", "-o", path("p"), "--picture", path("p.svg")});
    write("p/region-00000.npy", "a solution");
    write("p/notes.txt", "precious");
  }
  Arguments partition(const std::string& folder) const {
    return {"partition",  path("points.npy"), "--levels",  "2",          "-o",
            path(folder), "--force",          "--picture", path("p.svg")};
  }
};

TEST_F(PartitionFaultsTest, APartitionThatCannotBePlacedLeavesTheOldOne) {
  // Region 3 is only in the new partition, and the picture comes last.
  for (const char* folder : {"p", "new"}) {
    for (const std::string& name : {folder + std::string("/region-00003.node"), std::string("p.svg")}) {
      SCOPED_TRACE(folder + (" " + name));
      expect_unchanged({name, "Input/output error"}, partition(folder), with("fail-renames-to=" + name, {}));
    }
  }
}

TEST_F(PartitionFaultsTest, SignalsLeaveTheOldPartition) {
  const auto before = everything();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    for (const char* folder : {"p", "new"}) {
      SCOPED_TRACE(folder + std::to_string(signal));
      EXPECT_EQ(run(partition(folder), with("end-at-sync=" + std::to_string(signal), {})).signal, signal);
      EXPECT_EQ(everything(), before);
    }
  }
}

}  // namespace
