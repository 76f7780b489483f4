#!/usr/bin/env python3
"""Shows that tests find faults: puts each fault of a list into a copy of the source, and demands that a test fails.

  mutate.py                  all faults, which takes hours
  mutate.py NAME...          these alone

The copy and its build are in build/mutants: a later run compiles little, and the source is never changed. The test of
each fault must pass without it, and fail with it. What commands print is in build/mutants/build/mutate.log.
Exit code: 0 if all were found, otherwise 1. Tests of Python run with that of scripts/python-test.sh, or $PYTHON.

To add a fault, add a line to FAULTS: a name, the file, a text that is there exactly once, what it becomes, the kind of
mistake, and the test that finds it, as CTest has it. Choose the fault before you know what finds it. If nothing does,
write a test. What follows a test's name makes it shorter: a filter of GoogleTest, a call of `flaunay devices --test
--only`, or a test of pytest, by the program to which it goes. Kinds that begin with "again" were found and mended once.
"""
import argparse
import collections
import contextlib
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
COPY = SOURCE / "build/mutants"
BUILD = COPY / "build/release"
TIMEOUT_SECONDS = 900
CONFIGURE = ["cmake", "--preset", "release", "-DFLAUNAY_MPI=ON", "-DFLAUNAY_GDAL=ON", "-DFLAUNAY_BENCH=OFF"]
# What tests need beside or in place of the target of their name, by the first word of it.
TARGETS = {"conformance": ["flaunay_cli"], "oclgrind": ["flaunay_cli"], "mpi": ["test_mpi"], "python": ["flaunay"],
           "terrain_command": ["flaunay_cli"], "chunk_files": ["flaunay_cli"],
           "layers_command": ["flaunay_cli"], "faults": ["flaunay_cli", "c_test"]}
# As the presets of tests have it. What has failed once has found the fault.
ENVIRONMENT = {"POCL_CACHE_DIR": str(SOURCE / "build/kernels"), **os.environ, "FLAUNAY_CACHE_DIR": "",
               "GTEST_FAIL_FAST": "1"}
JOBS = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
PYTHON = os.environ.get("PYTHON", str(SOURCE / "build/python/bin/python"))

Fault = collections.namedtuple("Fault", "name file old new kind finder")
FAULTS = [Fault(*each) for each in [
    # ---- Kernels
    ("tile-starts", "kernels/points/distribute_tiles.cl",
     "    }\n  }\n  barrier(CLK_LOCAL_MEM_FENCE);\n  return sorted;",
     "    }\n  }\n  return sorted;",
     "a lost barrier", "oclgrind.blocks triangulate"),
    ("group-scan", "kernels/operations/work_group.h",
     "    *total = sums[group - 1];                                  \\\n"
     "    barrier(CLK_LOCAL_MEM_FENCE);                              \\\n",
     "    *total = sums[group - 1];                                  \\\n",
     "a lost barrier", "oclgrind.blocks sets"),
    ("scan-spans", "kernels/operations/scan_tiles.cl",
     "SUM_OF(sums, 0, spans > 1 && g < spans ? g : 0); ", "SUM_OF(sums, 0, spans > 1 && g < spans ? g - 1 : 0); ",
     "one span too few in a scan", "test_host *Scan*"),
    ("keys-of-halves", "kernels/blocks/group_halving.h",
     "if (a != b) return a < b;", "return a < b;",
     "ties of keys that are not decided", "test_blocks.device SmallHalve.*"),
    ("joined-boxes", "kernels/blocks/rounds.cl",
     "if (other < set_blocks[s + 1]) box", "if (other <= set_blocks[s + 1]) box",
     "a bound: the next set's block", "test_blocks SmallRounds.BoxesOfSetsAreJoined"),
    ("first-of-fan", "kernels/blocks/fans.cl",
     "return comes_before(vertex, points[edges[edges[e].previous].to]) && comes_before(vertex, points[edges[last].to]);",
     "return comes_before(vertex, points[edges[last].to]);",
     "a missing condition", "test_blocks SmallFans.*"),
    ("weights-of-vertices", "kernels/blocks/weighted.cl",
     "vertex_weights[v] = weights[source[v]];", "vertex_weights[v] = weights[v];",
     "a swapped index", "test_queries WeightedTest.FewPointsAreAsByBruteForce"),
    ("wedges-of-corners", "kernels/flattened/merge.cl",
     "return count + !end_is_after;", "return count + 1;",
     "a missing condition", "test_flattened Small*"),
    ("list-bounds", "kernels/flattened/lists.cl",
     "int previous = low > 0 ? regions[low - 1] : -1;", "int previous = -1;",
     "a chunk that does not look before itself", "test_flattened"),
    ("left-neighbours", "kernels/constrained/domain.cl",
     "u < 0 || places[u] == places[u + 1] ? -1 : (int)places[u];", "u < 0 ? -1 : (int)places[u];",
     "a missing condition", "test_domains SmallDomains.*"),
    ("seeds-in-range", "kernels/constrained/seeds.cl",
     "h < last && seeds[h].x <= most.x; ++h", "h < last && seeds[h].x < most.x; ++h",
     "< for <=", "test_domains SmallDomains.*:SmallCarried.*"),
    ("smoothed-edges", "kernels/refinement/moves.h",
     "  if (!(shortest >= rules.min_edge)) return 0;\n", "",
     "again: moves that make edges too short", "test_refinement *SmoothingMoves*"),
    ("rounded-proposals", "kernels/refinement/blocks.h",
     "(is_close && 64.0 * squared_distance(p - from, centre) > distance) ||\n      ", "",
     "again: points that rounding moves", "test_refinement *RoundedPoints"),
    ("frozen-edges", "kernels/refinement/smooth.cl",
     "if (edge >= 0 && (has_changed || (beyond >= 0 && changes[beyond] != 0)))", "if (edge >= 0 && has_changed)",
     "a stale flag", "test_refinement *EdgesThaw*"),
    ("rows-beside-flips", "kernels/updates/move.cl",
     "is_free_around(&mesh, t, claim, claims) &&\n        is_free_around(&mesh, u, claim, claims)",
     "is_free_around(&mesh, t, claim, claims)",
     "two that write one row", "oclgrind.groups updates"),
    ("flips-of-constraints", "kernels/updates/move.cl",
     "if (edge_at(mesh, corner) >= 0 || kind_of_row", "if (kind_of_row",
     "a missing condition", "test_updates *Constrain*"),
    ("smallest-of-two", "kernels/locate/locate.cl",
     "const int beyond = f.neighbor[ab == 0 ? k : bc == 0 ? at_a : at_b];\n      return beyond < 0 ? t : min(t, beyond);",
     "return t;",
     "a tie that is not broken", "test_queries SmallLocate.Grid"),
    ("nearest-of-two", "kernels/locate/fixed_point.cl",
     "if (sign > 0 || (sign == 0 && comes_before(p, at))) {", "if (sign > 0) {",
     "a tie that is not broken, in fixed point alone", "test_queries.device SmallLocate.FixedPointIsFull"),
    ("gradients-of-sets", "kernels/interpolate/gradients.cl",
     "scales[segment_of(v, sets, first_vertices)]", "scales[segment_of(v, 1, first_vertices)]",
     "the first set's value for all sets", "test_queries *Gradients.*:SmallInterpolation.*"),
    ("pixels-on-edges", "kernels/raster/scan.cl",
     "if (!has_longer_edge(other, longest)) return 0;", "return 0;",
     "a missing condition", "test_queries *Raster*"),
    ("clip-through-corners", "kernels/voronoi/clip.cl",
     "if (sign > 0 && next <= 0) crossed.x = i;", "if (sign > 0 && next < 0) crossed.x = i;",
     "< for <=", "test_queries SmallClip.*"),
    ("plain-polygons", "kernels/voronoi/plain_polygon.h",
     "return is_plain & (lowest == 1);", "return is_plain & (lowest >= 1);",
     "again: cells that go around twice", "test_queries *Mend.*"),
    ("cylinder-images", "kernels/periodic/torus.h",
     "if (all || at[axis] <= box->margin) range.high[axis] = 1;", "if (at[axis] <= box->margin) range.high[axis] = 1;",
     "images that are missing at ends", "test_queries Periodic.CylindersHaveTwoEnds:Periodic.TrianglesAreThoseOfAllImages"),
    ("sheared-reach", "src/space/periodic/torus.cpp",
     "lattice.reach[1] = widest_circle(across, shear, up);", "lattice.reach[1] = up;",
     "images that are missing above a sheared box", "test_queries Periodic.Sheared*"),
    ("weights-that-hide-nothing", "src/space/spaces.cpp",
     "mesh.is_weighted = space.weights != nullptr;", "mesh.is_weighted = !mesh.hidden.empty();",
     "again: weights known by hidden points alone", "test_queries WeightedTest.MeshesSay*"),
    ("rows-of-periods", "kernels/periodic/fold.cl",
     "        periods[3 * row + k] = VECTOR(uchar2, 0, 0);\n", "",
     "again: a member without a value", "test_embedding SmallPeriodicOnDevice.*"),
    ("rows-of-the-cap", "kernels/sphere/cap.cl",
     "const int shift = is_planar ? sums[s] - plane_sums[s] : 0;", "const int shift = 0;",
     "sets that have each other's rows", "test_embedding SmallSphereOnDevice.*"),
    # ---- The host
    ("cache-mode", "host/opencl/private_folder_posix.cpp",
     "(status.st_mode & (S_IWGRP | S_IWOTH)) == 0", "(status.st_mode & S_IWOTH) == 0",
     "again: a folder that a group can write to", "test_native SmallProgramCache.*"),
    ("cache-key", "host/opencl/program_cache.cpp",
     "  if (content.compare(begin, key.size(), key) != 0) return {};\n", "",
     "a file of another key", "test_native SmallProgramCache.*"),
    ("pool-size", "host/memory/buffer_pool.cpp",
     "while (!idle_.empty() && bytes_ + wanted > most) drop_one();",
     "while (!idle_.empty() && bytes_ > most) drop_one();",
     "a bound without what is added", "test_host SmallArena.*"),
    ("least-threads", "host/native/threads.cpp",
     "count < 1 || count > kMostThreads", "count > kMostThreads",
     "a missing bound", "test_native SmallThreads.AreCountedByTheEnvironment"),
    ("stale-kernels", "host/runtime.cpp",
     "  for (auto& kernels : kernels_) kernels.clear();\n", "",
     "kernels of other options", "test_host"),
    ("stable-sort", "host/launch/vector_operations.cpp",
     "std::upper_bound(keys, keys + i, keys[i]) - keys", "std::lower_bound(keys, keys + i, keys[i]) - keys",
     "a sort that is not stable", "test_host"),
    ("lent-memory", "host/memory/arena.cpp",
     "blocks_[0] = {memory, begin, offset + bytes < begin ? 0 : offset + bytes - begin, 0};",
     "blocks_[0] = {memory, begin, offset + bytes - begin, 0};",
     "a difference below 0", "test_host SmallArena.*"),
    ("staged-chunk", "host/opencl/staging.cpp", "    chunk.to = nullptr;\n", "",
     "a chunk that goes where an earlier read failed", "test_host SmallStaging.*"),
    ("reclaimable-memory", "host/memory/memory_left_posix.cpp",
     "limit(left, difference(*most, difference(*used, reclaimable)),", "limit(left, difference(*most, *used),",
     "a forgotten term", "test_host SmallSystemMemory.*"),
    # ---- The library
    ("mended-sets", "src/derived/voronoi/mend.cpp",
     "    complete_ = open_ = 0;\n", "    open_ = 0;\n",
     "again: nothing is reset between sets", "test_queries SmallMend.*"),
    ("open-contours", "src/derived/contours/contours.cpp",
     "  if (!piece.is_in_order) {", "  if (is_closed && !piece.is_in_order) {",
     "again: contours that meet themselves", "test_queries Contours.OfThinTrianglesAreSimple"),
    ("withheld", "src/app/files/las.hpp",
     "(record[15] & (format < 6 ? 0x80 : 4)) != 0", "(record[15] & 0x80) != 0",
     "again: withheld points of new formats", "test_io LasTest.*"),
    ("communicators", "src/large/mpi/ranks.cpp",
     "  check(MPI_Comm_set_attr(communicator, key_of_communicators(), made.get()), \"MPI_Comm_set_attr\");\n", "",
     "again: communicators that are never freed", "mpi.ranks Ranks.OfCommunicatorsThatEnd"),
    ("finished-points", "src/large/chunks/finish.cpp",
     "    if (points_.edge_count(v) > 0) unfinished[v] = 0;\n", "",
     "a missing condition", "test_chunks Chunks.*"),
    ("sorted-values", "src/large/chunks/points.cpp",
     "sorted.values.push_back(values[i]);", "sorted.values.push_back(values[sorted.size() - 1]);",
     "a swapped index", "test_queries RasterInChunks.HasTheBytesOfAllTrianglesAtOnce"),
    ("permissions", "src/files/output.cpp",
     "  if (target_.exists) system::set_permissions(descriptor_, target_.permissions);\n", "",
     "permissions that are not kept", "test_io IoTest.ReplacingKeepsModeAndSymbolicLink"),
    ("null-events", "src/c/handles.cpp",
     "  check_array(enqueue->wait_for, enqueue->wait_for_count, \"events to wait for\");\n", "",
     "a missed check for null", "test_arguments SmallArguments.InStructsOfC"),
    ("memory-status", "src/c/errors.cpp",
     "    return FLAUNAY_ERROR_MEMORY;\n", "    return FLAUNAY_ERROR_INPUT;\n",
     "a wrong kind of error", "test_allocations SmallAllocations.OfTheInterfaceForC"),
    ("lost-batches", "src/updates/living_mesh.cpp",
     "    points_.roll_back();\n    is_lost_ = true;\n", "    points_.roll_back();\n",
     "again: errors in the middle of a batch", "test_updates SmallUpdates.*"),
    ("order-of-leaving", "src/updates/living_mesh.cpp",
     "return numbers[a] > numbers[b]; });", "return numbers[a] < numbers[b]; });",
     "a sign", "test_updates *Updates.*"),
    ("roll-back", "src/updates/points.cpp",
     "for (auto before = before_.rbegin(); before != before_.rend(); ++before) {",
     "for (auto before = before_.begin(); before != before_.end(); ++before) {",
     "the wrong order", "test_updates SmallUpdates.ErrorsInTheMiddle"),
    ("renumbered-hulls", "src/constrained/refinement/result.cpp",
     "{&result.triangles, &result.hull, &result.constraint_edges", "{&result.triangles, &result.constraint_edges",
     "a forgotten array", "test_domains SmallRefined.*"),
    ("straight-hulls", "src/space/sphere/close.cpp",
     "const bool first_is_smaller = kernel::comes_before(place(first), place(last)) != 0;",
     "const bool first_is_smaller = kernel::comes_before(place(last), place(first)) != 0;",
     "swapped arguments", "test_queries Sphere.*"),
    ("moved-past-points", "src/constrained/crossings/split.cpp",
     "if ((is_moved_little && are_apart && points_are_apart()) || !parts_cross()) return;",
     "if ((is_moved_little && are_apart) || !parts_cross()) return;",
     "a missing condition", "test_constrained SmallSplit.*"),
    ("heights-outside", "src/app/command/heights.cpp",
     "    if (std::isnan(found[k])) found[k] = heights[static_cast<std::size_t>(nearest[k])];\n",
     "    if (std::isnan(found[k])) found[k] = heights[k % n];\n",
     "a wrong index", "test_cli CommandConstraintsTest.*"),
    ("edges-beside-places", "src/app/command/terrain_boundary.cpp",
     "if (edge.ay <= place.y && place.y < edge.by && edge.x_at(place.y) <= place.x)",
     "if (edge.ay <= place.y && place.y <= edge.by && edge.x_at(place.y) <= place.x)",
     "<= for <", "terrain_command"),
    # ---- Python
    ("package-ids", "src/app/files/layers_gdal.cpp",
     '    options.set("FID", own_name("fid", layer.fields).c_str());\n', "",
     "again: triangles of a feature with one key", "layers_command"),
    ("numbers-of-houses", "src/app/files/column_text.cpp",
     "const bool is_number = !is_name && ", "const bool is_number = ",
     "leading zeros are lost", "layers_command"),
    ("tiny-extents", "python/flaunay/_dynamic.py",
     "step = max(np.abs(there).max() * 2.0**-52, 2.0**-1074) * np.eye(2)",
     "step = np.abs(there).max() * 2.0**-52 * np.eye(2)",
     "again: extents of 2^-1074", "python test_dynamic.py"),
    ("nulls-in-lists", "python/flaunay/_arrays.py",
     "if given.null_count or given.flatten().null_count:", "if given.null_count:",
     "a missed check for null", "python test_arrays.py"),
    ("decimal-offsets", "python/flaunay/_terrain.py",
     "if whole and 1 / whole == scale and first / whole == offset and abs(first) < 1 << 62:",
     "if whole and 1 / whole == scale and abs(first) < 1 << 62:",
     "a wrong rounding", "python test_terrain.py"),
    ("columns-of-text", "python/flaunay/_terrain.py",
     "            usecols=places,\n", "            usecols=range(3),\n",
     "columns that are forgotten", "python test_terrain.py"),
    ("jettisoned-edges", "python/flaunay/triangle.py",
     'for name in result.keys() & {"triangles", "segments", "edges"}:',
     'for name in result.keys() & {"triangles", "segments"}:',
     "a forgotten array", "python test_triangle.py"),
    ("first-marker", "python/flaunay/triangle.py",
     'order = marked[np.argsort(-mesh["edge_segments"][marked], kind="stable")]',
     'order = marked[np.argsort(mesh["edge_segments"][marked], kind="stable")]',
     "a sign", "python test_triangle.py"),
    ("radius-alpha", "python/flaunay/_alpha_shape.py",
     "frozen(delaunay.circumradii <= alpha)", "frozen(delaunay.circumradii < alpha)",
     "< for <=", "python test_alpha_shape.py"),
    ("edges-beside", "python/flaunay/_border.py",
     "(last[:, None] + np.arange(-1, 2)) % count", "(last[:, None] + np.arange(0, 2)) % count",
     "a candidate that rounding needs", "python test_border.py"),
    ("unbounded-cells", "python/flaunay/_voronoi.py",
     "kept = (merged != merged[previous]) | (is_first & unbounded[cell])",
     "kept = (merged != merged[previous]) | is_first",
     "a missing condition", "python test_voronoi.py"),
    ("keys-of-edges", "python/flaunay/_graphs.py",
     "(corner + k) % 3].astype(np.int64) for k in (1, 2)]", "(corner + k) % 3] for k in (1, 2)]",
     "a wrong dtype", "python test_graphs.py"),
]]

def update():
    """Makes the copy as the source is. What is the same stays, so that little is compiled anew."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=SOURCE,
                            check=True, capture_output=True, text=True).stdout.split("\0")
    names = {name for name in listed if (SOURCE / name).is_file()}
    for path in COPY.rglob("*"):
        name = path.relative_to(COPY).as_posix()
        if path.is_file() and not name.startswith("build/") and name not in names:
            path.unlink()
    for name in names:
        to = COPY / name
        if not to.exists() or to.read_bytes() != (SOURCE / name).read_bytes():
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, to)


def call(command, environment=None, cwd=COPY):
    """Runs a command, with all that it starts. Returns whether it succeeded, and in time."""
    with open(COPY / "build/mutate.log", "ab") as log:
        log.write(f"\n== {' '.join(map(str, command))}\n".encode())
        log.flush()
        process = subprocess.Popen(command, cwd=cwd, stdout=log, stderr=log, start_new_session=True,
                                   env={**ENVIRONMENT, **(environment or {})})
        try:
            return process.wait(TIMEOUT_SECONDS) == 0
        except subprocess.TimeoutExpired:
            return False
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGTERM)


def make(finder):
    test = finder.split()[0].partition(".")[0]
    return call(["cmake", "--build", BUILD, "-j", JOBS, "--target", *TARGETS.get(test, [test])])


def passes(finder):
    """Runs a test, or a part of it."""
    test, *only = finder.split()
    if test == "python":
        return passes_pytest(only)
    shown = subprocess.run(["ctest", "--show-only=json-v1"], cwd=BUILD, check=True, capture_output=True).stdout
    # CTest has the tests of some programs one by one.
    entry = next((each for each in json.loads(shown)["tests"] if each["name"] == test),
                 {"command": [BUILD / "tests" / test]})
    command, properties = entry["command"], {each["name"]: each["value"] for each in entry.get("properties", [])}
    if only and test.startswith("conformance"):
        command += ["--only", *only]
    elif only and test.startswith("oclgrind"):
        command = command[:3] + only  # the script, the command, its tuning, calls
    elif only:
        command += [f"--gtest_filter={only[0]}"]  # the last one is what counts
    environment = dict(each.split("=", 1) for each in properties.get("ENVIRONMENT", []))
    return call(command, environment, properties.get("WORKING_DIRECTORY", COPY))


def passes_pytest(tests):
    """With the package put together in a folder, in place of an installed one."""
    package, headers = COPY / "build/package/flaunay", COPY / "src/include/flaunay"
    shutil.rmtree(package, ignore_errors=True)
    shutil.copytree(COPY / "python/flaunay", package)
    shutil.copy(BUILD / "src/libflaunay.so", package)
    return call([sys.executable, COPY / "scripts/declare.py", headers / "flaunay.h", headers / "result_arrays.hpp",
                 package / "_declarations.py"]) and call(
        [PYTHON, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
         *(COPY / "python/tests" / test for test in tests)],
        {"PYTHONPATH": str(package.parent), "PYTHONDONTWRITEBYTECODE": "1"})


def prove(fault, fine):
    """Returns what came of it: "found", or what is wrong. fine: what is known of tests without faults."""
    path = COPY / fault.file
    text = path.read_text(encoding="utf-8")
    if text.count(fault.old) != 1:
        return f"THE TEXT IS THERE {text.count(fault.old)} TIMES"
    if fault.finder not in fine:
        fine[fault.finder] = make(fault.finder) and passes(fault.finder)
    if not fine[fault.finder]:
        return "THE TEST FAILS WITHOUT THE FAULT"
    path.write_text(text.replace(fault.old, fault.new), encoding="utf-8")
    try:
        if not make(fault.finder):
            return "DOES NOT COMPILE"
        return "NOT FOUND" if passes(fault.finder) else "found"
    finally:
        path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="which faults; by default all")
    names = parser.parse_args().names
    unknown = set(names) - {fault.name for fault in FAULTS}
    if unknown:
        parser.error(f"there is no fault {', '.join(sorted(unknown))}")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # ends what was started
    (COPY / "build").mkdir(parents=True, exist_ok=True)
    update()
    if not call(CONFIGURE):
        sys.exit(f"mutate.py: CMake fails; see {COPY / 'build/mutate.log'}")
    fine, missed = {}, []
    faults = [fault for fault in FAULTS if not names or fault.name in names]
    for fault in faults:
        begin = time.time()
        outcome = prove(fault, fine)
        if outcome != "found":
            missed.append(fault.name)
        print(f"{fault.name:20}  {time.time() - begin:5.0f} s  {outcome}: {fault.kind}; {fault.file}; {fault.finder}",
              flush=True)
    print(f"{len(faults) - len(missed)} of {len(faults)} faults were found", *(f"missed: {name}" for name in missed),
          sep="\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
