// Sorts more records than fit memory: sorted runs go to a scratch file, and are merged when they are read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "app/verify/buffer.hpp"
#include "files/scratch.hpp"

namespace flaunay::prove {

/// Record: a plain struct. Less: a strict weak order, a function object without state.
template <typename Record, typename Less>
class ExternalSorter {
 public:
  /// Uses about `bytes` of memory, and the folder if that is not enough.
  ExternalSorter(std::string folder, std::uint64_t bytes)
      : folder_(std::move(folder)), records_(std::max<std::uint64_t>(2, bytes / sizeof(Record))) {}

  /// Several threads may call it at a time.
  void add(const Record* records, std::size_t count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (std::size_t done = 0; done < count;) {
      if (used_ == records_.size()) spill();
      const std::size_t part = std::min(count - done, records_.size() - used_);
      std::copy_n(records + done, part, records_.data() + used_);
      used_ += part;
      done += part;
    }
  }

  /// Calls visit(record) for all records in order. To be called once.
  template <typename Visit>
  void for_each(const Visit& visit) {
    std::sort(records_.data(), records_.data() + used_, Less());
    if (runs_.empty()) {
      for (std::size_t i = 0; i < used_; ++i) visit(records_[i]);
    } else {
      spill_sorted();
      merge(visit);
    }
  }

  std::uint64_t scratch_bytes() const { return written_ * sizeof(Record); }

 private:
  /// Records [next, end) of the scratch file must still be read, after the buffered ones.
  struct Run {
    std::uint64_t next, end;
    Record *buffer, *at, *last;
  };

  void spill() {
    std::sort(records_.data(), records_.data() + used_, Less());
    spill_sorted();
  }

  void spill_sorted() {
    if (!file_) file_.emplace(folder_);
    file_->append(records_.data(), used_ * sizeof(Record));
    runs_.push_back({written_, written_ + used_, nullptr, nullptr, nullptr});
    written_ += used_;
    used_ = 0;
  }

  /// Reads the next records if the buffer is used up. Returns false at the run's end.
  bool fill(Run& run, std::size_t room) const {
    if (run.at != run.last) return true;
    const std::size_t count = std::min<std::uint64_t>(room, run.end - run.next);
    file_->read_at(run.next * sizeof(Record), count * sizeof(Record), run.buffer);
    run.next += count;
    run.at = run.buffer;
    run.last = run.buffer + count;
    return count > 0;
  }

  template <typename Visit>
  void merge(const Visit& visit) {
    const std::size_t room = std::max<std::size_t>(1, records_.size() / runs_.size());
    if (room * runs_.size() > records_.size()) records_.allocate(room * runs_.size());
    const auto later = [](const Run* a, const Run* b) { return Less()(*b->at, *a->at); };
    std::vector<Run*> heap;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      runs_[i].buffer = runs_[i].at = runs_[i].last = records_.data() + i * room;
      if (fill(runs_[i], room)) heap.push_back(&runs_[i]);
    }
    std::make_heap(heap.begin(), heap.end(), later);
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), later);
      Run* run = heap.back();
      visit(*run->at++);
      if (fill(*run, room)) {
        std::push_heap(heap.begin(), heap.end(), later);
      } else {
        heap.pop_back();
      }
    }
  }

  std::string folder_;
  Buffer<Record> records_;
  std::size_t used_ = 0;
  std::optional<io::ScratchFile> file_;
  std::uint64_t written_ = 0;  // records in the file
  std::vector<Run> runs_;
  std::mutex mutex_;
};

}  // namespace flaunay::prove
