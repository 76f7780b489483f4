/* The types of OpenCL handles in flaunay's interface, declared as in OpenCL's headers. Those may be included
 * before or after this one; programs with points in host memory do not need them. C11 and C++. */
#ifndef FLAUNAY_OPENCL_H
#define FLAUNAY_OPENCL_H

typedef struct _cl_context* cl_context;
typedef struct _cl_device_id* cl_device_id;
typedef struct _cl_command_queue* cl_command_queue;
typedef struct _cl_mem* cl_mem;
typedef struct _cl_event* cl_event;

#endif
