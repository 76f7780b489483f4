// Reading and writing data that other work-items of a launch change, where the old and the new value will do.
//
// Atomic operations see all changes. Where caches are coherent, plain ones do as well. host/native/opencl.hpp has them
// for the host.
#ifndef FLAUNAY_MEANWHILE_H
#define FLAUNAY_MEANWHILE_H

#ifndef __cplusplus
#if ATOMIC_READS
#define read_shared(at) atomic_or(at, 0)
#define write_shared(at, value) atomic_xchg(at, value)
#else
#define read_shared(at) (*(at))
#define write_shared(at, value) (*(at) = (value))
#endif
#endif

#endif
