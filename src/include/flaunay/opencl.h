/* The handles of OpenCL that flaunay takes, declared as OpenCL's headers declare them: whoever has those may
 * include them before or after, and whoever only has points in host memory needs none. C11 and C++. */
#ifndef FLAUNAY_OPENCL_H
#define FLAUNAY_OPENCL_H

typedef struct _cl_context* cl_context;
typedef struct _cl_device_id* cl_device_id;
typedef struct _cl_command_queue* cl_command_queue;
typedef struct _cl_mem* cl_mem;
typedef struct _cl_event* cl_event;

#endif
