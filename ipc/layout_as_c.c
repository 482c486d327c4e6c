/* Compiled as C11, so that the headers other languages read stay C. */
#include "ipc/control_layout.h"
#include "ipc/segment_counters.h"
#include "ipc/segment_layout.h"

typedef int linescope_layout_is_c;
