// What lets the predicates' headers be read by OpenCL C and C++ alike, so that kernels and the host's twin decide by the
// same text; src/recursive/predicates.hpp is the C++ side, with the types and built-in functions of OpenCL C they use.
#ifndef FLAUNAY_LANGUAGE_H
#define FLAUNAY_LANGUAGE_H

#ifndef __cplusplus
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF
#define PAIR(x, y) ((double2)(x, y))
#define OUT_OF_LINE  // where C++ is not to inline what is rarely called
#endif

#endif
