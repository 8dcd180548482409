// Selects the kernels of an instruction set, which are compiled once for each.
#pragma once

#include "msm/kernels/instruction_set.h"

/// The `table` of kernels that the namespace of the instruction set `set` defines.
#ifdef SPRINGPROOF_X86_KERNELS
#define SPRINGPROOF_KERNELS_OF(set, table) \
  ((set) == InstructionSet::avx512 ? avx512::table : (set) == InstructionSet::avx2 ? avx2::table : portable::table)
#else
#define SPRINGPROOF_KERNELS_OF(set, table) (static_cast<void>(set), portable::table)
#endif
