// Runs kernels on an OpenCL device.
#pragma once

#include <boost/compute/command_queue.hpp>

#include "host/backend.hpp"
#include "host/opencl/programs.hpp"
#include "host/opencl/staging.hpp"

namespace flaunay::host {

class OpenClBackend : public Backend {
 public:
  OpenClBackend(Accounts& accounts, const boost::compute::context& context,
                const boost::compute::device& device);
  ~OpenClBackend() override;

  std::string name() const override { return device_.name(); }
  MemorySource memory() const override { return memory_of(context_, device_); }
  std::unique_ptr<Kernel> make_kernel(const KernelName& name, const std::string& options,
                                      bool counting) override;
  void forget_programs() override { programs_.clear(); }
  void launch(Kernel& kernel, std::size_t work_items, std::size_t group) override;
  void read(cl_mem from, std::size_t offset, std::size_t bytes, void* to, bool wait) override;
  void write(cl_mem to, std::size_t offset, std::size_t bytes, const void* from, bool wait) override;
  void fill(cl_mem to, std::size_t offset, std::size_t bytes, const void* value,
            std::size_t value_bytes) override;
  void copy(cl_mem from, std::size_t from_offset, cl_mem to, std::size_t to_offset,
            std::size_t bytes) override;
  std::shared_ptr<_cl_mem> wrap(void* memory, std::size_t bytes, cl_mem_flags access) override;
  void hand_over(cl_mem shared, std::size_t bytes) override;
  // Pages are touched while the device computes.
  void touch_new(void*, std::size_t) override {}
  void use_queue(cl_command_queue wanted, bool profiling) override;
  void wait_for(const std::vector<cl_event>& events) override;
  cl_event mark() override;
  void await(cl_event event) override;
  void flush() override;
  void finish() override;
  void settle() const override;
  void collect_times() override;

  boost::compute::device device() const override { return device_; }
  boost::compute::context context() const override { return context_; }
  cl_command_queue queue() const override { return queue_.get(); }
  cl_command_queue own_queue() const override { return own_queues_[0].get(); }
  std::string identity() const override;

 private:
  boost::compute::command_queue make_queue(bool profiling) const;
  /// Makes later commands wait for commands enqueued on the other queue.
  void follow(cl_command_queue other);
  /// To be called after each command: on an out-of-order queue, makes the next command wait for it.
  void keep_order();
  /// Returns the pinned memory for a transfer of so many bytes; null if they are transferred directly.
  Staging* staging_for(std::size_t bytes);
  /// To be called after the commands of a transfer.
  void end_transfer(bool wait);
  /// After a wait: the values of earlier reads have arrived.
  void finish_reads() {
    if (staging_ != nullptr) staging_->finish();
  }

  boost::compute::device device_;
  boost::compute::context context_;
  bool on_pocl_;
  boost::compute::command_queue own_queues_[2];  // the second one times kernels, and is made on first use
  boost::compute::command_queue queue_;
  bool profiling_ = false;
  bool is_unordered_ = false;
  Programs programs_;
  struct TimedLaunch {
    cl_event event;
    const std::string* kernel;
    std::size_t launch;  // in the log, if there is one
  };
  std::vector<TimedLaunch> events_;
  std::unique_ptr<Staging> staging_;  // made for the first large transfer
  std::size_t staging_of_ = 0;        // the staging_bytes for which it was made, or could not be
};

}  // namespace flaunay::host
