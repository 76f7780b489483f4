#include "host/runtime.hpp"

#include <fmt/format.h>

#include <utility>

#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/memory/counting.hpp"
#include "host/native/backend.hpp"
#include "host/system/pages.hpp"
#ifndef FLAUNAY_WITHOUT_OPENCL
#include "host/opencl/backend.hpp"
#include "host/opencl/launch_check.hpp"
#endif

namespace flaunay::host {

Runtime::Runtime(const boost::compute::device& device, Settings settings)
    : Runtime(boost::compute::context(device), device, std::move(settings)) {}

Runtime::Runtime([[maybe_unused]] const boost::compute::context& context,
                 [[maybe_unused]] const boost::compute::device& device, Settings settings)
    : Runtime(std::move(settings), [&]([[maybe_unused]] Accounts& accounts) -> std::unique_ptr<Backend> {
#ifdef FLAUNAY_WITHOUT_OPENCL
        throw DeviceError("this build of flaunay does not use OpenCL devices");
#else
        return std::make_unique<OpenClBackend>(accounts, context, device);
#endif
      }) {
}

Runtime::Runtime(std::shared_ptr<const Sizes> sizes, std::size_t threads)
    : Runtime(Settings{std::move(sizes)},
              [threads](Accounts& accounts) { return std::make_unique<NativeBackend>(accounts, threads); }) {}

Runtime::Runtime(const Runtime& counted, std::shared_ptr<const Sizes> sizes)
    : Runtime({std::move(sizes), counted.capabilities()}, [&](Accounts& accounts) {
        return std::make_unique<CountingBackend>(accounts, counted.memory().alignment);
      }) {
  counts_only_ = true;
  arena_.count_only();
}

Runtime::Runtime(Settings settings, const MakeBackend& make)
    : sizes_(std::move(settings.sizes)),
      capabilities_(settings.capabilities),
      backend_(make(accounts_)),
#ifndef FLAUNAY_WITHOUT_OPENCL
      is_native_(backend_->threads() > 0),
#endif
      arena_(memory()) {
  backend_->staging_bytes = sizes_->staging_bytes;
}

// Kernels may still use kept buffers and the memory of the arena.
Runtime::~Runtime() { settle(); }

MemorySource Runtime::memory() const {
  MemorySource source = backend_->memory();
  source.arrays = static_cast<ArrayMemory>(std::min<std::size_t>(sizes_->separate_buffers, 2));
  return source;
}

std::string Runtime::build_options() const {
  return fmt::format("{} {}", sizes_->build_options(), capabilities_.build_options());
}

void Runtime::set(Settings settings) {
  // Pending times refer to kernels by name.
  backend_->collect_times();
  const std::string compiled_for = build_options();
  sizes_ = std::move(settings.sizes);
  capabilities_ = settings.capabilities;
  backend_->staging_bytes = sizes_->staging_bytes;
  if (build_options() == compiled_for) return;
  for (auto& kernels : kernels_) kernels.clear();
  backend_->forget_programs();
}

void Runtime::set_counters(const Buffer<cl_uint>& counters) {
  counters_ = counters;
  counting_ = counters.memory() != nullptr;
}

void Runtime::record_launches(const CountedWords& words) {
  // Pending times refer to launches of another log, if any.
  backend_->collect_times();
  accounts_.log = std::make_unique<LaunchLog>(memory(), words);
  if (words.length == 0) return;
  set_counters(accounts_.log->counters());
  uncounted([&] { fill(counters_, counters_.size(), cl_uint{0}); });
}

void Runtime::stop_recording() {
  if (accounts_.log == nullptr) return;
  // The device may still write counters to the log.
  settle();
  if (accounts_.log->words().length > 0) set_counters({});
  accounts_.log = nullptr;
}

std::vector<Launch> Runtime::recorded_launches() {
  if (accounts_.log == nullptr) return {};
  backend_->collect_times();
  settle();
  return accounts_.log->launches();
}

// Reads the counts of the last launch and sets them to 0.
void Runtime::record_counted() {
  const CountedWords& words = accounts_.log->words();
  const std::size_t offset = words.first * sizeof(cl_uint), bytes = words.count * sizeof(cl_uint);
  const cl_uint zero = 0;
  cl_uint* const counted = accounts_.log->counted_of_last();
  uncounted([&] {
    backend_->read(counters_.memory(), offset, bytes, counted, false);
    backend_->fill(counters_.memory(), offset, bytes, &zero, sizeof zero);
  });
}

void Runtime::read_bytes(cl_mem from, std::size_t offset, std::size_t bytes, void* to) {
  backend_->read(from, offset, bytes, to, true);
  // Everything that was enqueued before is complete. A blocking write may return as soon as the driver has a
  // copy, before earlier commands have ended, as it does with Intel's CPU runtime: so kept values stay there.
  kept_.clear();
}

Kernel& Runtime::find_kernel(const KernelName& name) {
  auto& kernels = kernels_[counting_];
  const auto found = kernels.find(&name);
  if (found != kernels.end()) return *found->second;
  return *kernels.emplace(&name, backend_->make_kernel(name, build_options(), counting_)).first->second;
}

void Runtime::launch_on_device(const KernelName& name, ArgumentList& arguments, std::size_t work_items,
                               std::size_t group) {
  Kernel& kernel = find_kernel(name);
  // A kernel that has one more argument counts.
  const bool counts = counting_ && kernel.takes_counters(static_cast<cl_uint>(arguments.size()));
  if (counts) arguments(counters_);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    kernel.set_argument(static_cast<cl_uint>(k), arguments.values()[k], arguments.bytes(k));
  }
#ifndef FLAUNAY_WITHOUT_OPENCL
  LaunchCheck* const check = LaunchCheck::of_thread();
  if (check != nullptr && !counts) {
    group = std::max<std::size_t>(1, std::min(group, kernel.largest_group));
    check->launch(name, arguments, (work_items + group - 1) / group * group, group, build_options(),
                  *backend_, [&] { backend_->launch(kernel, work_items, group); });
    return;
  }
#endif
  backend_->launch(kernel, work_items, group);
  if (counts && accounts_.log != nullptr) record_counted();
}

void Runtime::touch_new(void* begin, std::size_t bytes) {
  system::prefer_huge_pages(begin, bytes);
  backend_->touch_new(begin, bytes);
}

std::map<std::string, KernelTime> Runtime::kernel_times() {
  backend_->collect_times();
  return accounts_.times;
}

double Runtime::working_clock() const { return now() - accounts_.all_build_seconds; }

void Runtime::reset_accounts() {
  backend_->collect_times();
  if (accounts_.log != nullptr) settle();
  accounts_.reset();
  arena_.reset_peak();
}

}  // namespace flaunay::host
