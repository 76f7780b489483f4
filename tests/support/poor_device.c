/* To be preloaded: devices have less than they have, and calls that need more fail as they do on such
 * devices.
 *
 * POOR_DEVICE is a list of these words, separated by spaces; without it, it is "no-fp64":
 *   no-fp64            no double precision. Programs do not compile if they name the type, or use its
 * extension no-int64-atomics   no atomic operations on 64 bits local=BYTES        local memory. As with
 * drivers of GPUs, a program does not build if one kernel needs more group=COUNT        work-items of a group
 *   buffer=BYTES       the largest buffer
 *   address-bits=32    global sizes and memory that 32 bits can count
 *   big-endian         it says that its bytes are in the other order
 *   texts=FOLDER       no limit: each program's options, as a comment, and its text are written to a file
 * there What is compiled for such a device is kept apart from other compiled programs, since its driver's
 * version differs.
 */
#define _GNU_SOURCE
#include <CL/cl.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct {
  int no_fp64, no_int64_atomics, is_32_bit, big_endian;
  size_t local, group, buffer;
  const char* texts;
  const char* words;
} limits;

static size_t least(size_t a, size_t b) { return b < a ? b : a; }

__attribute__((constructor)) static void read_limits(void) {
  limits.local = limits.group = limits.buffer = SIZE_MAX;
  const char* text = getenv("POOR_DEVICE");
  limits.words = text != NULL ? text : "no-fp64";
  char* save = NULL;
  for (char* word = strtok_r(strdup(limits.words), " ", &save); word != NULL;
       word = strtok_r(NULL, " ", &save)) {
    char* value = strchr(word, '=');
    if (value != NULL) *value++ = '\0';
    const size_t number = value != NULL ? strtoul(value, NULL, 10) : 0;
    if (strcmp(word, "no-fp64") == 0) {
      limits.no_fp64 = 1;
    } else if (strcmp(word, "no-int64-atomics") == 0) {
      limits.no_int64_atomics = 1;
    } else if (strcmp(word, "big-endian") == 0) {
      limits.big_endian = 1;
    } else if (strcmp(word, "address-bits") == 0 && number == 32) {
      limits.is_32_bit = 1;
    } else if (strcmp(word, "local") == 0 && number > 0) {
      limits.local = number;
    } else if (strcmp(word, "group") == 0 && number > 0) {
      limits.group = number;
    } else if (strcmp(word, "buffer") == 0 && number > 0) {
      limits.buffer = number;
    } else if (strcmp(word, "texts") == 0 && value != NULL) {
      limits.texts = value;
    } else {
      fprintf(stderr, "POOR_DEVICE: what is '%s'?\n", word);
      abort();
    }
  }
}

/* The loader's function. A program that loads OpenCL as it runs has it behind nothing. */
static void find(const char* name, void* function, size_t size) {
  static void* loader = NULL;
  if (loader == NULL) loader = dlopen("libOpenCL.so.1", RTLD_LAZY);
  void* found = dlsym(loader, name);
  if (found == NULL) abort();
  /* ISO C has no cast from what dlsym returns to a function. */
  memcpy(function, &found, size);
}
#define REAL(name)               \
  static __typeof__(&name) real; \
  if (real == NULL) find(#name, &real, sizeof real)

static cl_int real_device_info(cl_device_id device, cl_device_info name, size_t size, void* value,
                               size_t* needed) {
  REAL(clGetDeviceInfo);
  return real(device, name, size, value, needed);
}

static cl_int answer(const void* answered, size_t answered_size, size_t size, void* value, size_t* needed) {
  if (value != NULL && size < answered_size) return CL_INVALID_VALUE;
  if (value != NULL) memcpy(value, answered, answered_size);
  if (needed != NULL) *needed = answered_size;
  return CL_SUCCESS;
}

/* The device's own text, with room for more. */
static char* device_text(cl_device_id device, cl_device_info name, size_t more) {
  size_t size = 0;
  if (real_device_info(device, name, 0, NULL, &size) != CL_SUCCESS) abort();
  char* text = calloc(size + more + 1, 1);
  if (real_device_info(device, name, size, text, NULL) != CL_SUCCESS) abort();
  return text;
}

static cl_int answer_text(char* text, size_t size, void* value, size_t* needed) {
  const cl_int code = answer(text, strlen(text) + 1, size, value, needed);
  free(text);
  return code;
}

static void remove_words(char* text, const char* part) {
  for (char* found = text; (found = strstr(found, part)) != NULL;) {
    char* begin = found;
    while (begin > text && begin[-1] != ' ') --begin;
    const char* end = found + strcspn(found, " ");
    memmove(begin, end, strlen(end) + 1);
    found = begin;
  }
}

cl_int CL_API_CALL clGetDeviceInfo(cl_device_id device, cl_device_info name, size_t size, void* value,
                                   size_t* needed) {
  if (name == CL_DEVICE_EXTENSIONS) {
    char* text = device_text(device, name, 0);
    if (limits.no_fp64) remove_words(text, "cl_khr_fp64");
    if (limits.no_int64_atomics) remove_words(text, "cl_khr_int64_");
    return answer_text(text, size, value, needed);
  }
  if (name == CL_DRIVER_VERSION) {
    char* text = device_text(device, name, strlen(limits.words) + 1);
    return answer_text(strcat(strcat(text, " "), limits.words), size, value, needed);
  }
  const cl_int code = real_device_info(device, name, size, value, needed);
  if (code != CL_SUCCESS || value == NULL) return code;
  switch (name) {
    case CL_DEVICE_DOUBLE_FP_CONFIG:
    case CL_DEVICE_PREFERRED_VECTOR_WIDTH_DOUBLE:
    case CL_DEVICE_NATIVE_VECTOR_WIDTH_DOUBLE:
      if (limits.no_fp64) memset(value, 0, size);
      break;
    case CL_DEVICE_LOCAL_MEM_SIZE:
      *(cl_ulong*)value = least(*(cl_ulong*)value, limits.local);
      break;
    case CL_DEVICE_MAX_WORK_GROUP_SIZE:
      *(size_t*)value = least(*(size_t*)value, limits.group);
      break;
    case CL_DEVICE_MAX_WORK_ITEM_SIZES:
      for (size_t k = 0; k < size / sizeof(size_t); ++k) {
        ((size_t*)value)[k] = least(((size_t*)value)[k], limits.group);
      }
      break;
    case CL_DEVICE_MAX_MEM_ALLOC_SIZE:
      *(cl_ulong*)value =
          least(*(cl_ulong*)value, least(limits.buffer, limits.is_32_bit ? 1UL << 30 : SIZE_MAX));
      break;
    case CL_DEVICE_GLOBAL_MEM_SIZE:
      if (limits.is_32_bit) *(cl_ulong*)value = least(*(cl_ulong*)value, 1UL << 32);
      break;
    case CL_DEVICE_ADDRESS_BITS:
      if (limits.is_32_bit) *(cl_uint*)value = 32;
      break;
    case CL_DEVICE_ENDIAN_LITTLE:
      if (limits.big_endian) *(cl_bool*)value = CL_FALSE;
      break;
    default:
      break;
  }
  return code;
}

cl_mem CL_API_CALL clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                                  cl_int* code) {
  REAL(clCreateBuffer);
  if (size > limits.buffer || (limits.is_32_bit && size > 1UL << 30)) {
    if (code != NULL) *code = CL_INVALID_BUFFER_SIZE;
    return NULL;
  }
  return real(context, flags, size, host, code);
}

/* Comes before a program's text. PoCL's own headers, which know doubles, have been read by then. */
static const char without_fp64[] =
    "#undef cl_khr_fp64\n"
    "#undef __opencl_c_fp64\n"
    "#define double this_device_has_no_double\n"
    "#define double2 this_device_has_no_double\n"
    "#define double3 this_device_has_no_double\n"
    "#define double4 this_device_has_no_double\n"
    "#define double8 this_device_has_no_double\n"
    "#define double16 this_device_has_no_double\n"
    "#define convert_double this_device_has_no_double\n"
    "#define as_double this_device_has_no_double\n";

/* The texts of programs, until they are built. */
static struct {
  cl_program program;
  char* text;
} texts[256];

static void keep_text(cl_program program, cl_uint count, const char** strings, const size_t* lengths) {
  for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
    if (texts[k].text != NULL) continue;
    size_t size = 0;
    FILE* out = open_memstream(&texts[k].text, &size);
    for (cl_uint s = 0; s < count; ++s) {
      const int has_length = lengths != NULL && lengths[s] > 0;
      fwrite(strings[s], 1, has_length ? lengths[s] : strlen(strings[s]), out);
    }
    fclose(out);
    texts[k].program = program;
    return;
  }
  abort();
}

static void write_text(cl_program program, const char* options) {
  static int number = 0;
  for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
    if (texts[k].text == NULL || texts[k].program != program) continue;
    char path[4096];
    snprintf(path, sizeof path, "%s/%d-%d.cl", limits.texts, (int)getpid(), number++);
    FILE* out = fopen(path, "w");
    if (out == NULL) abort();
    fprintf(out, "// %s\n%s", options != NULL ? options : "", texts[k].text);
    fclose(out);
    free(texts[k].text);
    texts[k].text = NULL;
    return;
  }
}

cl_program CL_API_CALL clCreateProgramWithSource(cl_context context, cl_uint count, const char** strings,
                                                 const size_t* lengths, cl_int* code) {
  REAL(clCreateProgramWithSource);
  const char** all = malloc((count + 1) * sizeof *all);
  size_t* all_lengths = calloc(count + 1, sizeof *all_lengths);
  all[0] = limits.no_fp64 ? without_fp64 : "\n";
  for (cl_uint k = 0; k < count; ++k) {
    all[k + 1] = strings[k];
    if (lengths != NULL) all_lengths[k + 1] = lengths[k];
  }
  cl_program program = real(context, count + 1, all, all_lengths, code);
  free(all);
  free(all_lengths);
  if (program != NULL && limits.texts != NULL) keep_text(program, count, strings, lengths);
  return program;
}

static cl_int real_group_info(cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info name,
                              size_t size, void* value, size_t* needed) {
  REAL(clGetKernelWorkGroupInfo);
  return real(kernel, device, name, size, value, needed);
}

cl_int CL_API_CALL clGetKernelWorkGroupInfo(cl_kernel kernel, cl_device_id device,
                                            cl_kernel_work_group_info name, size_t size, void* value,
                                            size_t* needed) {
  const cl_int code = real_group_info(kernel, device, name, size, value, needed);
  if (code == CL_SUCCESS && name == CL_KERNEL_WORK_GROUP_SIZE && value != NULL) {
    *(size_t*)value = least(*(size_t*)value, limits.group);
  }
  return code;
}

/* Whether all kernels of a program have the local memory that they need. */
static int have_local_memory(cl_program program, cl_device_id device) {
  cl_uint count = 0;
  if (clCreateKernelsInProgram(program, 0, NULL, &count) != CL_SUCCESS) return 1;
  cl_kernel* kernels = calloc(count, sizeof *kernels);
  if (clCreateKernelsInProgram(program, count, kernels, NULL) != CL_SUCCESS) abort();
  int all_fit = 1;
  for (cl_uint k = 0; k < count; ++k) {
    cl_ulong bytes = 0;
    char name[256] = "";
    real_group_info(kernels[k], device, CL_KERNEL_LOCAL_MEM_SIZE, sizeof bytes, &bytes, NULL);
    if (bytes > limits.local) {
      clGetKernelInfo(kernels[k], CL_KERNEL_FUNCTION_NAME, sizeof name, name, NULL);
      fprintf(stderr, "POOR_DEVICE: kernel %s needs %lu bytes of local memory\n", name, (unsigned long)bytes);
      all_fit = 0;
    }
    clReleaseKernel(kernels[k]);
  }
  free(kernels);
  return all_fit;
}

cl_int CL_API_CALL clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                                  const char* options, void(CL_CALLBACK* notify)(cl_program, void*),
                                  void* user_data) {
  REAL(clBuildProgram);
  if (limits.texts != NULL) write_text(program, options);
  const cl_int code = real(program, count, devices, options, notify, user_data);
  if (code != CL_SUCCESS || limits.local == SIZE_MAX || count == 0) return code;
  return have_local_memory(program, devices[0]) ? CL_SUCCESS : CL_BUILD_PROGRAM_FAILURE;
}

cl_int CL_API_CALL clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                          const size_t* offset, const size_t* global, const size_t* local,
                                          cl_uint wait_count, const cl_event* wait_list, cl_event* event) {
  REAL(clEnqueueNDRangeKernel);
  size_t group = 1;
  for (cl_uint k = 0; k < dimensions; ++k) {
    if (local != NULL) group *= local[k];
    if (limits.is_32_bit && global[k] > UINT32_MAX) return CL_INVALID_GLOBAL_WORK_SIZE;
  }
  if (group > limits.group) return CL_INVALID_WORK_GROUP_SIZE;
  return real(queue, kernel, dimensions, offset, global, local, wait_count, wait_list, event);
}
