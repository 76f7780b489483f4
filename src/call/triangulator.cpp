// The public members of Triangulator, which turn errors of OpenCL into Errors. Other files do the work.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "blocks/memory.hpp"
#include "call/device_info.hpp"
#include "call/handles.hpp"
#include "call/implementation.hpp"

namespace flaunay {
namespace {

// The parent of a sub-device, or null.
cl_device_id parent_of(cl_device_id device) {
  cl_device_id parent = nullptr;
  const cl_int code = clGetDeviceInfo(device, CL_DEVICE_PARENT_DEVICE, sizeof(parent), &parent, nullptr);
  return code == CL_SUCCESS ? parent : nullptr;
}

boost::compute::device checked_member(cl_context context, cl_device_id device) {
  if (context == nullptr || device == nullptr) {
    throw Error(ErrorKind::usage, "a triangulator needs a context and a device, or neither");
  }
  std::size_t bytes = 0;
  const cl_int code = clGetContextInfo(context, CL_CONTEXT_DEVICES, 0, nullptr, &bytes);
  if (code != CL_SUCCESS) {
    throw Error(ErrorKind::usage, fmt::format("the context is none: {}", host::error_name(code)), code,
                "clGetContextInfo");
  }
  std::vector<cl_device_id> members(bytes / sizeof(cl_device_id));
  FLAUNAY_CL(clGetContextInfo(context, CL_CONTEXT_DEVICES, bytes, members.data(), nullptr));
  // Some implementations name the whole device in the place of a part of it.
  const auto is_member = [&](cl_device_id id) {
    return std::find(members.begin(), members.end(), id) != members.end();
  };
  cl_device_id parent = device;
  while (parent != nullptr && !is_member(parent)) parent = parent_of(parent);
  if (parent == nullptr) {
    throw Error(ErrorKind::usage, "the device is not one of the context");
  }
  return boost::compute::device(device);
}

}  // namespace

Triangulator::Triangulator(const std::string& device)
    : implementation_(with_errors([&] { return std::make_shared<Implementation>(device); })) {}

Triangulator::Triangulator(cl_context context, cl_device_id device)
    : implementation_(with_errors([&] {
        const boost::compute::device member = checked_member(context, device);
        return std::make_shared<Implementation>(boost::compute::context(context), member);
      })) {}

Triangulator::~Triangulator() {
  // Waits even if a locator keeps the device's memory alive. A destructor cannot report errors, so they are
  // ignored.
  if (implementation_) implementation_->settle();
}
Triangulator::Triangulator(Triangulator&&) noexcept = default;
Triangulator& Triangulator::operator=(Triangulator&&) noexcept = default;

DeviceInfo Triangulator::device() const {
  return with_errors([&] { return call::describe(implementation_->for_host_memory().runtime); });
}

cl_context Triangulator::context() const {
  return with_errors([&] { return implementation_->on_device().runtime.context().get(); });
}
cl_device_id Triangulator::device_id() const {
  return with_errors([&] { return implementation_->on_device().runtime.device().id(); });
}
cl_command_queue Triangulator::queue() const {
  return with_errors([&] { return implementation_->on_device().runtime.own_queue(); });
}

std::size_t Triangulator::capacity() const {
  return with_errors([&] { return implementation_->for_host_memory().capacity(); });
}

std::size_t Triangulator::workspace_bytes(std::size_t n, std::size_t sets) const {
  return with_errors([&] {
    const call::Engine& engine = implementation_->on_device();
    engine.check_size(n);
    check_count(sets, "sets");
    const blocks::WorkspaceBytes needed = blocks::workspace_bytes(engine.runtime, n, sets);
    return needed.persistent + needed.scratch;
  });
}

void Triangulator::use_workspace(cl_mem workspace) {
  call::take_turn(*implementation_, [&] {
    call::Engine& self = implementation_->on_device();
    std::shared_ptr<_cl_mem> lent;
    if (workspace != nullptr) {
      call::check_buffer(self.runtime, workspace, 1, call::Access::workspace, "the workspace");
      cl_mem parent = nullptr;
      FLAUNAY_CL(clGetMemObjectInfo(workspace, CL_MEM_ASSOCIATED_MEMOBJECT, sizeof parent, &parent, nullptr));
      if (parent != nullptr) {
        throw Error(ErrorKind::usage,
                    "the workspace must not be a sub-buffer: it is divided into such itself");
      }
      lent = call::retained(workspace);
    }
    self.use_own_memory();
    self.runtime.finish();
    self.workspace = std::move(lent);
  });
}

const char* version() noexcept { return FLAUNAY_VERSION; }

const Enqueue& own_queue() noexcept {
  static const Enqueue enqueue;
  return enqueue;
}

const Parts& triangles_alone() noexcept {
  static const Parts parts;
  return parts;
}

}  // namespace flaunay
