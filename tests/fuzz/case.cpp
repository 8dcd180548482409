// Case files.  What is read must read back from what is written of it, word for word.
#include "fuzz/reader.h"
#include "problem/case_file/experiment.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace springproof;
  return fuzz::read_or_refuse<InputError>([&] {
    const Experiment read = parse_experiment(std::string(fuzz::view(data, size)), "case.toml");
    const std::string written = to_toml(read);
    try {
      const std::string again = to_toml(parse_experiment(written, "written.toml"));
      if (again != written)
        fuzz::finding("what is written reads back as something else:", (written + "\n----\n" + again).c_str());
    } catch (const InputError& refusal) {
      fuzz::finding("what is written is refused:", refusal.what());
    }
  });
}
