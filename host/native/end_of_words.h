// Undefines the macros of host/native/words.h.
#undef kernel
#undef global
#undef restrict
#undef local
#undef barrier
#undef reqd_work_group_size
