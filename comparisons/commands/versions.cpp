#include "comparisons/commands/commands.h"

#include <fmt/format.h>
#include <xxhash.h>
#include <zlib.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "fem_reference/exchange/reference.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// 90100 -> "9.1.0"
std::string dotted(unsigned number) {
  return fmt::format("{}.{}.{}", number / 10000, number / 100 % 100, number % 100);
}

std::string or_absent(const std::string& version) { return version.empty() ? "is not here" : version; }

}  // namespace

std::string versions() {
  std::string text = fmt::format("springproof {}\n", SPRINGPROOF_VERSION);
  text += fmt::format("Eigen {}.{}.{}, fmt {}, CLI11 {}, ", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
                      EIGEN_MINOR_VERSION, dotted(FMT_VERSION), CLI11_VERSION);
  text += fmt::format("nlohmann-json {}.{}.{}, toml++ {}, ", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                      NLOHMANN_JSON_VERSION_PATCH, SPRINGPROOF_TOMLPLUSPLUS_VERSION);
  text += fmt::format("xxHash {}, zlib {}, TinyGLTF {}\n", dotted(XXH_VERSION_NUMBER), zlibVersion(),
                      SPRINGPROOF_TINYGLTF_VERSION);
  text += fmt::format("springproof-fem: {}\n", or_absent(fem::version()));
  text += fmt::format("springproof-mesh: {}",
                      or_absent(version_of(find_program("springproof-mesh", "SPRINGPROOF_MESH_PROGRAM"))));
  const std::string petsc = SPRINGPROOF_PETSC_VERSION;
  if (!petsc.empty()) text += fmt::format("\nspringproof-bench, springproof-mpi: PETSc {}", petsc);
  return text;
}

}  // namespace springproof
