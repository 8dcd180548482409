#include "msm/kernels/instruction_set.h"

#include <cstdlib>
#include <stdexcept>

namespace springproof {

// msm/kernels/compiled/all_kernels.cpp, once per instruction set.
namespace avx2 {
extern const CompiledWith compiled_with;
}
namespace avx512 {
extern const CompiledWith compiled_with;
}

namespace {

#ifdef SPRINGPROOF_X86_KERNELS
bool runs_here(const CompiledWith& kernels) {
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
             avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  return (avx2 || !kernels.avx2) && (avx512 || !kernels.avx512);
}
#endif

std::vector<InstructionSet> find_usable() {
  std::vector<InstructionSet> sets = {InstructionSet::portable};
#ifdef SPRINGPROOF_X86_KERNELS
  if (runs_here(avx2::compiled_with)) sets.push_back(InstructionSet::avx2);
  if (runs_here(avx512::compiled_with)) sets.push_back(InstructionSet::avx512);
#endif
  return sets;
}

InstructionSet choose() {
  const auto& sets = usable_instruction_sets();
  const char* wanted = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
  if (!wanted || !*wanted) return sets.back();
  std::string names;
  for (InstructionSet set : sets) {
    if (name_of(set) == wanted) return set;
    names += (names.empty() ? "" : ", ") + name_of(set);
  }
  throw std::runtime_error("SPRINGPROOF_INSTRUCTION_SET = \"" + std::string(wanted) +
                           "\" cannot be used here (allowed: " + names + ")");
}

}  // namespace

std::string name_of(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
    default:
      return "portable";
  }
}

const std::vector<InstructionSet>& usable_instruction_sets() {
  static const std::vector<InstructionSet> sets = find_usable();
  return sets;
}

InstructionSet instruction_set() {
  static const InstructionSet set = choose();
  return set;
}

}  // namespace springproof
