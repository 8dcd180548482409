// Case files.  What is read is a case that can be solved: materials that exist, a place for every load.
#include "fuzz/reader.h"
#include "problem/case_file/experiment.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<InputError>([&] {
    const Experiment read = parse_experiment(std::string(fuzz::view(data, size)), "case.toml");
    fuzz::require(!read.materials.empty(), "a case has materials");
    for (const IsotropicMaterial& material : read.materials) try {
        check(material);
      } catch (const std::exception& refusal) {
        fuzz::finding("a material that is read is refused later:", refusal.what());
      }
    fuzz::require(!read.loads.empty() && read.loads.size() == read.load_locations.size(), "every load has its place");
    fuzz::require(read.body.resolutions() > 0, "a body has a resolution");
  });
}
