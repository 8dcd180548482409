// STL files for the tests of the command line: good ones, broken ones and a table of these.   write_bodies FOLDER
//   FOLDER/NAME.stl, FOLDER/broken/NAME.stl, FOLDER/broken.txt: name, "mended" or "refused", what is to be said; by
//   tabs
#include <fmt/format.h>

#include <fstream>

#include "support/broken_stl.h"

using namespace springproof;
using namespace springproof::test;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder / "broken");
  write_stl_binary(folder / "trefoil.stl", trefoil(0.45, 240, 16));
  write_stl_ascii(folder / "noisy_sphere.stl", noisy_sphere(1, 4, 0.02, 7));
  write_stl_ascii(folder / "scan.stl", scan(4, 0.005, 3));
  std::ofstream table(folder / "broken.txt");
  for (const BrokenFile& file : broken_files()) {
    file.write(folder / "broken" / (file.name + ".stl"));
    table << fmt::format("{}\t{}\t{}\n", file.name, file.mended ? "mended" : "refused", file.outcome);
  }
  return table ? 0 : 1;
}
