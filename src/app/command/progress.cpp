#include "app/command/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "host/system/process.hpp"

namespace flaunay::cli {

namespace {

constexpr std::chrono::milliseconds kSlow(500);
constexpr std::chrono::milliseconds kRedraw(100);
// Before, an estimate would jump.
constexpr double kEstimateAfterSeconds = 3;
constexpr const char* kClearLine = "\r\x1b[K";

std::string time_left(double seconds) {
  const auto rounded = static_cast<long long>(std::ceil(seconds));
  const long long minutes = rounded / 60, hours = minutes / 60;
  if (hours > 0) return fmt::format("about {}:{:02} h left", hours, minutes % 60);
  if (minutes > 0) return fmt::format("about {}:{:02} min left", minutes, rounded % 60);
  return fmt::format("about {} s left", rounded);
}

}  // namespace

Progress::Progress(bool wanted) {
  if (!wanted || system::terminal_width() == 0) return;
  try {
    drawer_ = std::thread([this] { draw_until_finished(); });
  } catch (const std::system_error&) {
    // If the system refuses the thread, nothing is drawn.
  }
}

Progress::~Progress() { finish(); }

void Progress::update(const std::string& stage, int level, double done) {
  const std::lock_guard<std::mutex> lock(mutex_);
  stage_ = stage;
  stage_if_slow_.clear();
  level_ = level;
  if (first_done_ < 0 || done < done_) {
    first_done_ = done;
    first_time_ = Clock::now();
  }
  done_ = done;
}

void Progress::update_slow(const std::string& stage, const std::string& if_slow) {
  update(stage);
  const std::lock_guard<std::mutex> lock(mutex_);
  stage_if_slow_ = if_slow;
  stage_start_ = Clock::now();
}

void Progress::finish() {
  if (!drawer_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    finished_ = true;
  }
  finish_asked_.notify_one();
  drawer_.join();
}

void Progress::draw_until_finished() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto finished = [this] { return finished_; };
  if (finish_asked_.wait_for(lock, kSlow, finished)) return;
  do {
    const std::string text = line();
    // Unlocked, so that the work does not wait for a slow terminal.
    lock.unlock();
    system::write_to_terminal(kClearLine + text.substr(0, system::terminal_width() - 1));
    lock.lock();
  } while (!finish_asked_.wait_for(lock, kRedraw, finished));
  system::write_to_terminal(kClearLine);
}

std::string Progress::line() const {
  std::string text = stage_;
  if (!stage_if_slow_.empty() && Clock::now() - stage_start_ >= kSlow) text = stage_if_slow_;
  if (level_ >= 0) text += fmt::format(", level {}", level_);
  if (done_ >= 0) {
    constexpr int kBarLength = 30;
    const double done = std::clamp(done_, 0.0, 1.0);
    const int filled = static_cast<int>(done * kBarLength);
    text = fmt::format("{:<28} [{:#<{}}{:.<{}}] {:3.0f}%", text, "", filled, "", kBarLength - filled,
                       std::floor(100 * done));
    const double passed = std::chrono::duration<double>(Clock::now() - first_time_).count();
    if (passed >= kEstimateAfterSeconds && done > first_done_) {
      text += ", " + time_left(passed * (1 - done) / (done - first_done_));
    }
  }
  return text;
}

}  // namespace flaunay::cli
