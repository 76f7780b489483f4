// Makes the words of OpenCL C known to C++, so that a C++ file can include a kernel file: its kernels become
// functions that are called once per work-item. It stands inside namespace flaunay::kernel and directly
// before the kernel file; host/native/end_of_words.h stands directly behind. There is no include guard,
// because both can come repeatedly.
#define kernel __attribute__((unused)) static
#define global
#define restrict __restrict
// Work-groups have one work-item each: local memory is its own, and it waits for nobody.
#define local
#define barrier(fence) static_cast<void>(0)
#define reqd_work_group_size(x, y, z) unused
