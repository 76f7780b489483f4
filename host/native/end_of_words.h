// Ends what host/native/words.h begins.
#undef kernel
#undef global
#undef restrict
#undef local
#undef barrier
#undef reqd_work_group_size
