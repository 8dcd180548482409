// Springs files.  What is read is a network at rest, every index of it a node.
#include <nlohmann/json.hpp>

#include "fuzz/reader.h"
#include "msm/exchange/springs_file.h"
#include "problem/system/input_error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<InputError>([&] {
    const SpringsFile read = parse_springs(fuzz::view(data, size), "springs.json");
    const Network& network = read.model.network;
    fuzz::require(network.nodes() > 0 && network.volume.size() == network.nodes(), "every node has a mass");
    fuzz::require(network.volume.minCoeff() > 0, "every mass is positive");
    for (const Spring& s : network.springs)
      fuzz::require(0 <= s.i && s.i < s.j && s.j < network.nodes(), "a spring connects two nodes");
    fuzz::require(forces(read.model, network.X).allFinite(), "forces at rest are finite");
    fuzz::require(springs_as_json(read).size() > 0, "what is read can be written");
  });
}
