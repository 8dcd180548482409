// Kernels are compiled once per instruction set (msm/CMakeLists.txt); one is selected at run time (CPU dispatch).
#pragma once

#include <string>
#include <vector>

namespace springproof {

enum class InstructionSet { portable, avx2, avx512 };

std::string name_of(InstructionSet set);

/// The instructions that the kernels of a set were compiled with.
struct CompiledWith {
  bool avx2, avx512;
};

/// Instruction sets that this program has kernels for and this processor supports, the widest last.
const std::vector<InstructionSet>& usable_instruction_sets();

/// The instruction set in use: the widest usable, or the one that SPRINGPROOF_INSTRUCTION_SET names ("portable",
/// "avx2", "avx512").
/// @throws std::runtime_error if it names one that is not usable here.
InstructionSet instruction_set();

}  // namespace springproof
