// Refuses big-endian processors: arrays of the host and of devices are the same bytes, and files are read and
// written as they are.
#pragma once

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "flaunay needs a little-endian processor");
