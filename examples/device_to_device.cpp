// A kernel makes points, flaunay triangulates them, and another kernel uses the triangles, all in device
// memory. The host receives only sizes and, at the end, one number.
//
//   device_to_device [N]

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <cstdio>
#include <cstdlib>
#include <flaunay/device_memory.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

const char* const kSource = R"(
// Makes a random point of the unit square from its number (by the mixing function of SplitMix64).
ulong mixed(ulong x) {
  x += 0x9e3779b97f4a7c15UL;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9UL;
  x = (x ^ x >> 27) * 0x94d049bb133111ebUL;
  return x ^ x >> 31;
}
kernel void make_points(int n, global double2* points) {
  const int i = get_global_id(0);
  if (i < n) points[i] = (double2)((mixed(2 * i) >> 11) * 0x1p-53, (mixed(2 * i + 1) >> 11) * 0x1p-53);
}

// Each work-item adds up the areas of some triangles.
kernel void sum_areas(int count, global const double2* points, global const int* triangles, global double* sums) {
  const int w = get_global_id(0), workers = get_global_size(0);
  double sum = 0;
  for (int t = w; t < count; t += workers) {
    const double2 a = points[triangles[3 * t]];
    const double2 ab = points[triangles[3 * t + 1]] - a, ac = points[triangles[3 * t + 2]] - a;
    sum += (ab.x * ac.y - ab.y * ac.x) / 2;
  }
  sums[w] = sum;
}
)";
constexpr std::size_t kWorkers = 256;

void check(cl_int code, const char* call) {
  if (code != CL_SUCCESS) throw std::runtime_error(call + (": " + std::to_string(code)));
}

// This program's own context, queue and kernels.
struct Program {
  explicit Program(cl_device_id device) {
    cl_int code = CL_SUCCESS;
    context.reset(clCreateContext(nullptr, 1, &device, nullptr, nullptr, &code), clReleaseContext);
    check(code, "clCreateContext");
    queue.reset(clCreateCommandQueue(context.get(), device, 0, &code), clReleaseCommandQueue);
    check(code, "clCreateCommandQueue");
    const char* source = kSource;
    program.reset(clCreateProgramWithSource(context.get(), 1, &source, nullptr, &code), clReleaseProgram);
    check(code, "clCreateProgramWithSource");
    check(clBuildProgram(program.get(), 1, &device, "-cl-std=CL1.2", nullptr, nullptr), "clBuildProgram");
  }
  std::shared_ptr<_cl_kernel> kernel(const char* name) const {
    cl_int code = CL_SUCCESS;
    std::shared_ptr<_cl_kernel> made(clCreateKernel(program.get(), name, &code), clReleaseKernel);
    check(code, "clCreateKernel");
    return made;
  }
  std::shared_ptr<_cl_mem> buffer(std::size_t bytes) const {
    cl_int code = CL_SUCCESS;
    std::shared_ptr<_cl_mem> made(clCreateBuffer(context.get(), CL_MEM_READ_WRITE, bytes, nullptr, &code),
                                  clReleaseMemObject);
    check(code, "clCreateBuffer");
    return made;
  }
  template <typename... Arguments>
  void run(const char* name, std::size_t work_items, const Arguments&... arguments) const {
    const auto made = kernel(name);
    cl_uint index = 0;
    (check(clSetKernelArg(made.get(), index++, sizeof(Arguments), &arguments), "clSetKernelArg"), ...);
    check(clEnqueueNDRangeKernel(queue.get(), made.get(), 1, nullptr, &work_items, nullptr, 0, nullptr,
                                 nullptr),
          "clEnqueueNDRangeKernel");
  }

  std::shared_ptr<_cl_context> context;
  std::shared_ptr<_cl_command_queue> queue;
  std::shared_ptr<_cl_program> program;
};

void run(std::size_t n) {
  // Any device would do; this is the one that flaunay would choose.
  const cl_device_id device = flaunay::Triangulator().device_id();
  const Program program(device);
  flaunay::Triangulator triangulator(program.context.get(), device);

  const auto points = program.buffer(n * sizeof(cl_double2));
  program.run("make_points", n, static_cast<cl_int>(n), points.get());

  flaunay::DevicePoints input;
  input.memory = points.get();
  input.count = n;
  flaunay::Enqueue enqueue;
  enqueue.queue = program.queue.get();
  flaunay::DeviceTriangulation mesh;  // the first call makes its buffers, and later calls use them again
  triangulator.triangulate(input, mesh, flaunay::Parts(), enqueue);

  const std::size_t count = mesh.triangle_offsets.back();
  const auto sums = program.buffer(kWorkers * sizeof(cl_double));
  program.run("sum_areas", kWorkers, static_cast<cl_int>(count), points.get(), mesh.triangles.memory(),
              sums.get());
  std::vector<double> host_sums(kWorkers);
  check(clEnqueueReadBuffer(program.queue.get(), sums.get(), CL_TRUE, 0, kWorkers * sizeof(cl_double),
                            host_sums.data(), 0, nullptr, nullptr),
        "clEnqueueReadBuffer");
  double area = 0;
  for (const double sum : host_sums) area += sum;

  std::printf("%zu points, %zu triangles, area of the hull %.6f\n", n, count, area);
  std::printf("crossed meanwhile: %zu bytes to the device, %zu to the host; the points have %zu\n",
              mesh.statistics.bytes_to_device, mesh.statistics.bytes_to_host, n * sizeof(cl_double2));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100000);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
