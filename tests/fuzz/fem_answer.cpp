// Answers of springproof-fem.  Whatever is thrown becomes one sentence in fem::solve.
#include <fstream>
#include <nlohmann/json.hpp>

#include "fem_reference/exchange/exchange.h"
#include "fuzz/reader.h"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  using namespace springproof;
  return fuzz::write_seed([](const char* file) {
    fem::Solution solution;
    solution.displacement = NodalVectors::Ones(2, 3);
    solution.stress = fem::Stresses::Ones(1, 6);
    solution.reactions.push_back({"z_min", {0, 0, 1}, {0, 1, 0}});
    std::ofstream out(file, std::ios::binary);
    nlohmann::json::to_cbor(to_json(std::vector{solution}), out);
  });
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<std::exception>(
      [&] { fem::solutions_from_json(nlohmann::json::from_cbor(fuzz::view(data, size))); });
}
