#include "large/chunks/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "flaunay/result_arrays.hpp"
#include "geometry/euler.hpp"
#include "host/clock.hpp"
#include "host/note.hpp"
#include "large/chunks/finish.hpp"

namespace flaunay::chunks {
namespace {

// The share of a call's time that is over when all points are in chunks, for progress.
constexpr double kDistributed = 0.25;

// A sink that several threads write to. After an error nothing more is written.
class SharedSink : public MeshSink {
 public:
  explicit SharedSink(MeshSink& sink) : sink_(sink) {
    for (const MeshArray array : kArrays) wanted_[static_cast<std::size_t>(array)] = sink.wants(array);
  }
  bool wants(MeshArray array) const override { return wanted_[static_cast<std::size_t>(array)]; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    write_alone([&] { sink_.write(array, first, values, count); });
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    write_alone([&] { sink_.write_doubles(array, first, values, count); });
  }
  // Writes nothing any more, because of this error.
  void close(const std::exception_ptr& error) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = error;
  }

 private:
  template <typename Write>
  void write_alone(const Write& write) {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(failure_);
    try {
      write();
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

#define ARRAY(name) MeshArray::name,
  static constexpr std::array kArrays{FLAUNAY_MESH_ARRAYS(ARRAY)};
#undef ARRAY

  MeshSink& sink_;
  std::array<bool, kArrays.size()> wanted_{};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

// Data that all rounds share.
struct Call {
  SharedSink& sink;
  const Values* values;
  Folding* folding;
  ScratchFile& file;
  geometry::Scaling scaling;
  kernel::vertex_box all;
  std::uint64_t rows = 0;      // triangles so far
  std::uint64_t dropped = 0;   // final ones without a row
  std::uint64_t vertices = 0;  // distinct points
};

// The chunks of a round, which solvers take from one queue. Each has a thread of its own. A chunk's rows
// follow the rows of the chunk before, so a solver that has finished a chunk waits until the sizes of all
// earlier chunks are known. It writes the chunk while it solves the next one.
class Round {
 public:
  Round(Call& call, std::vector<Chunk> chunks, bool is_first, HandedOn& next, ChunkStatistics& statistics)
      : call_(call),
        chunks_(std::move(chunks)),
        is_first_(is_first),
        next_(next),
        statistics_(statistics),
        paces_(statistics.devices.size()) {}

  // The only chunk of the last round, which is not on disk.
  void set_last(ChunkPoints points) { last_ = std::move(points); }

  // progress: called on this thread with the share of the chunks that is done.
  ChunkRound run(const std::vector<Solver>& solvers, std::vector<bool>& is_lost,
                 const std::function<void(double done)>& progress) {
    std::vector<std::thread> threads;
    try {
      std::vector<std::size_t> usable;
      for (std::size_t s = 0; s < solvers.size(); ++s) {
        if (!is_lost[s]) usable.push_back(s);
      }
      for (const std::size_t s : usable) {
        {
          const std::lock_guard lock(mutex_);
          ++working_;
        }
        const auto solve = [this, &solvers, &is_lost, s] {
          bool lost = false;
          work(solvers[s], s, lost);
          const std::lock_guard lock(mutex_);
          is_lost[s] = lost;
          --working_;
          changed_.notify_all();
        };
        try {
          threads.emplace_back(solve);
        } catch (const std::system_error& error) {
          // If the system refuses a thread, the other solvers do its work.
          if (threads.empty()) {
            throw Error(ErrorKind::device, fmt::format("there is no thread for chunks: {}", error.what()));
          }
          const std::lock_guard lock(mutex_);
          --working_;
        }
      }
      await(progress);
    } catch (...) {
      stop(std::current_exception());
    }
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
    if (turn_ < chunks_.size()) std::rethrow_exception(lost_);
    return result_;
  }

 private:
  // How fast a solver is, in chunks per second; unknown, 0, before its first one and when it is lost.
  struct Pace {
    double chunks = 0, seconds = 0;

    double speed() const { return seconds > 0 ? chunks / seconds : 0; }
  };

  bool is_last() const { return last_.has_value(); }

  void await(const std::function<void(double done)>& progress) {
    std::unique_lock lock(mutex_);
    std::size_t reported = turn_;
    while (working_ > 0 && !error_) {
      changed_.wait(lock);
      if (turn_ == reported) continue;
      reported = turn_;
      lock.unlock();
      progress(static_cast<double>(reported) / static_cast<double>(chunks_.size()));
      lock.lock();
    }
  }

  void stop(const std::exception_ptr& error) {
    {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = error;
      changed_.notify_all();
    }
    call_.sink.close(error);
  }

  // The chunk that a solver does after the one that it has. It may not come before that, as those do that a
  // lost solver gave back: each would wait for the other's turn.
  std::optional<std::size_t> take_following(std::size_t solver) {
    const std::lock_guard lock(mutex_);
    return error_ ? std::nullopt : take_new(solver, 1);
  }

  // The next chunk of an idle solver: first a chunk that a lost solver gave back. Waits until there is one,
  // or all are done.
  std::optional<std::size_t> await_chunk(std::size_t solver) {
    std::unique_lock lock(mutex_);
    std::optional<std::size_t> k;
    changed_.wait(lock, [&] {
      if (error_) return true;
      k = returned_.empty() ? take_new(solver, 0) : take_returned();
      return k || turn_ == chunks_.size();
    });
    return k;
  }

  // One that nobody had, for a solver that has `held` others.
  std::optional<std::size_t> take_new(std::size_t solver, std::size_t held) {
    if (taken_ == chunks_.size() || is_faster_without(solver, held)) return std::nullopt;
    return taken_++;
  }

  std::size_t take_returned() { return returned_.extract(returned_.begin()).value(); }

  // Whether the other solvers would triangulate all remaining chunks before this one finishes one more. This
  // is never true of the fastest idle solver, so some solver takes every chunk.
  bool is_faster_without(std::size_t solver, std::size_t held) const {
    double others = 0, fastest = 0;
    for (std::size_t s = 0; s < paces_.size(); ++s) {
      if (s == solver) continue;
      others += paces_[s].speed();
      fastest = std::max(fastest, paces_[s].speed());
    }
    const double own = paces_[solver].speed();
    if (own == 0 || others == 0) return false;
    const auto left = static_cast<double>(chunks_.size() - taken_);
    return static_cast<double>(held + 1) / own > std::max(left / others, 1 / fastest);
  }

  // For the other solvers, if there are some. reason: why the solver was lost, null if that is known already.
  void give_back(std::size_t solver, std::size_t k, std::exception_ptr reason = nullptr) {
    const std::lock_guard lock(mutex_);
    paces_[solver] = {};
    returned_.insert(k);
    if (reason) lost_ = std::move(reason);
    changed_.notify_all();
  }

  // Waits until it is the turn of chunk k. If a chunk before it is given back meanwhile, returns that one.
  std::optional<std::size_t> await_turn(std::size_t k) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock,
                  [&] { return error_ || turn_ == k || (!returned_.empty() && *returned_.begin() < k); });
    if (error_ || turn_ == k) return std::nullopt;
    return take_returned();
  }

  // A solver's thread, and the chunk that it writes meanwhile.
  struct Worker {
    const Solver& solver;
    std::size_t number;
    host::Threads threads{};
    std::future<void> writing{};
  };

  void work(const Solver& solver, std::size_t number, bool& is_lost) {
    Worker worker{solver, number};
    try {
      std::optional<std::size_t> following;
      std::future<ChunkPoints> loaded;
      while (!is_lost) {
        const std::optional<std::size_t> k = following ? following : await_chunk(number);
        if (!k) break;
        if (!following) loaded = load(*k);
        ChunkPoints points = loaded.get();
        following = take_following(number);
        if (following) loaded = load(*following);
        is_lost = !process(worker, *k, std::move(points));
        if (is_lost && following) give_back(number, *following);
      }
      if (worker.writing.valid()) worker.writing.get();
    } catch (...) {
      stop(std::current_exception());
    }
  }

  // If the system refuses a thread, chunks are read and written when the futures are asked.
  std::future<ChunkPoints> load(std::size_t k) {
    return std::async([this, k] {
      return is_last() ? std::move(*last_) : read_chunk(call_.file, chunks_[k].stored, is_first_);
    });
  }

  // Returns whether the solver can go on; if not, the chunk is given back.
  bool process(Worker& worker, std::size_t k, ChunkPoints points) {
    Triangulation mesh;
    const double begin = host::now();
    try {
      mesh = worker.solver.triangulate(points.coordinates.data(), points.size());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::device) throw;
      if (is_last()) last_ = std::move(points);
      give_back(worker.number, k, std::current_exception());
      return false;
    }
    const Statistics statistics = mesh.statistics;
    auto finished = std::make_shared<FinishedChunk>(
        worker.threads, std::move(points), std::move(mesh),
        Place{is_last() ? whole_plane() : chunks_[k].rectangle, call_.all}, call_.scaling, call_.folding);
    if (is_first_ && call_.values != nullptr)
      finished->merge_values(call_.values->duplicates, call_.values->fixed);
    note_pace(worker.number, host::now() - begin);
    while (const std::optional<std::size_t> before = await_turn(k)) {
      if (!process(worker, *before, load(*before).get())) {
        // This chunk is solved, but the solver is lost: others would wait for its turn.
        give_back(worker.number, k);
        return false;
      }
    }
    const std::optional<std::uint64_t> first_row = publish(k, worker.number, *finished, statistics);
    if (!first_row) return true;  // another one failed
    if (worker.writing.valid()) worker.writing.get();
    worker.writing = std::async([this, chunk = std::move(finished), row = *first_row]() mutable {
      try {
        chunk->write(call_.sink, row);
        if (is_first_) chunk->write_duplicates(call_.sink);
        if (is_last()) chunk->write_hull(call_.sink);
        if (call_.values != nullptr) call_.values->take(std::move(*chunk).take_surface());
      } catch (...) {
        stop(std::current_exception());
      }
      chunk.reset();  // its memory, before anybody asks whether this is done
    });
    return true;
  }

  void note_pace(std::size_t solver, double seconds) {
    const std::lock_guard lock(mutex_);
    ++paces_[solver].chunks;
    paces_[solver].seconds += seconds;
    changed_.notify_all();  // who is the fastest may be another now
  }

  // Ends the turn of chunk k. Returns the number of its first row, unless the round has failed.
  std::optional<std::uint64_t> publish(std::size_t k, std::size_t solver, const FinishedChunk& chunk,
                                       const Statistics& made) {
    const std::lock_guard lock(mutex_);
    if (error_) return std::nullopt;
    const std::uint64_t first_row = call_.rows;
    call_.rows += chunk.triangles();
    call_.dropped += chunk.dropped();
    if (call_.folding != nullptr) call_.folding->add(chunk.folds(*call_.folding, first_row, is_last()));
    if (is_first_) call_.vertices += chunk.points().size() - made.duplicates;
    statistics_.duplicates += made.duplicates;
    statistics_.undecided += made.undecided;
    const bool is_known = made.host_points > 0 && statistics_.host_points > 0;
    if (!is_known) host::append_note(statistics_.note, made.note);
    statistics_.host_points += made.host_points;
    statistics_.device_points[solver] += chunk.points().size();
    result_.points += chunk.points().size();
    result_.triangles += chunk.triangles();
    ++result_.chunks;
    if (is_last()) {
      statistics_.hull_vertices = chunk.mesh().hull.size();
    } else {
      const ChunkPoints open = chunk.handed_on(first_row);
      result_.handed_on += open.size();
      next_.add(open);
      for (const Extent& extent : chunks_[k].stored.extents) call_.file.release(extent.begin, extent.bytes);
    }
    ++turn_;
    changed_.notify_all();
    return first_row;
  }

  Call& call_;
  std::vector<Chunk> chunks_;
  bool is_first_;
  HandedOn& next_;
  ChunkStatistics& statistics_;
  std::optional<ChunkPoints> last_;
  ChunkRound result_;
  std::vector<Pace> paces_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t taken_ = 0, turn_ = 0, working_ = 0;
  std::set<std::size_t> returned_;
  std::exception_ptr error_, lost_;
};

void require_memory(std::uint64_t points, const Plan& plan) {
  if (points <= plan.largest_chunk) return;
  throw Error(
      ErrorKind::input,
      fmt::format("{} points are left to one last chunk, because too little is final in smaller ones (as of "
                  "points on one circle), but {} permits {}",
                  points, plan.limit, plan.largest_chunk));
}

}  // namespace

ChunkStatistics run(PointSource& source, const Values* values, MeshSink& given_sink, const Plan& plan,
                    const std::vector<Solver>& solvers, const ChunkOptions& options, Folding* folding) {
  const double begin = host::now();
  double phase_begin = begin;
  ChunkStatistics statistics;
  statistics.points = source.size();
  statistics.chunk_points = plan.chunk_points;
  statistics.device_points.resize(solvers.size());
  for (const Solver& solver : solvers) statistics.devices.push_back(solver.name);
  const auto end_phase = [&](const std::string& name) {
    const double now = host::now();
    statistics.phases.push_back({name, now - phase_begin});
    phase_begin = now;
  };
  const auto progress = [&](const char* stage, int round, double done) {
    if (options.progress) options.progress(stage, round, done);
  };

  SharedSink sink(given_sink);
  ScratchFile file(options.scratch);
  host::Threads threads;
  FirstRound first =
      distribute(source, values, sink, file, plan, threads,
                 [&](const char* step, double done) { progress(step, 0, kDistributed * done); });
  statistics.duplicates = first.equal_points;
  end_phase("distribute");

  Call call{sink, values, folding, file, first.scaling, first.all};
  std::vector<bool> is_lost(solvers.size(), false);
  std::vector<Chunk> chunks = std::move(first.chunks);
  std::optional<ChunkPoints> last;
  double done = kDistributed;
  for (int r = 0;; ++r) {
    const bool is_first = r == 0;
    if (is_first && chunks.size() == 1) last = read_chunk(file, chunks.front().stored, true);
    const bool is_last = last.has_value();
    HandedOn next(file);
    Round round(call, std::move(chunks), is_first, next, statistics);
    if (last) round.set_last(std::move(*last));
    last.reset();
    // Later rounds have a few hundredths of the points.
    const double end = is_last ? 1 : 1 - (1 - done) * 0.1;
    const ChunkRound result = round.run(
        solvers, is_lost, [&](double share) { progress("triangulating", r, done + (end - done) * share); });
    done = end;
    statistics.rounds.push_back(result);
    end_phase(fmt::format("round {}", r));
    if (is_last) break;
    const std::uint64_t open = next.points();
    const bool stalls = 100 * open > static_cast<std::uint64_t>(plan.most_handed_on_percent) * result.points;
    if (open <= plan.chunk_points || stalls) {
      require_memory(open, plan);
      last = next.read_all();
      chunks = {Chunk{{}, whole_plane()}};
    } else {
      chunks = next.distribute(plan);
    }
  }
  statistics.triangles = call.rows;
  geometry::check_euler(call.rows + call.dropped, statistics.hull_vertices, call.vertices);
  statistics.scratch_bytes = file.largest_bytes();
  statistics.seconds = host::now() - begin;
  progress("triangulating", static_cast<int>(statistics.rounds.size()) - 1, 1);
  return statistics;
}

}  // namespace flaunay::chunks
