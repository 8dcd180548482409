// Part files as they lie on disk, and the same with the right checksum, so that what is beneath it is reached too.
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "comparisons/sweep/sweep.h"
#include "fuzz/reader.h"
#include "problem/files/files.h"

namespace {

using namespace springproof;

const std::string stamp = "a stamp";

bool load(std::string_view bytes) {
  static const int file = memfd_create("part", 0);
  fuzz::require(ftruncate(file, 0) == 0 && pwrite(file, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()),
                "the bytes can be given");
  return load_part(fmt::format("/proc/self/fd/{}", file), stamp).has_value();
}

std::string with_true_checksum(std::string_view bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) return std::string(bytes);
  const std::string_view heading = bytes.substr(0, end), body = bytes.substr(end + 1);
  return fmt::format("{}{}\n{}", heading.substr(0, heading.rfind(' ') + 1), checksum(body), body);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  return fuzz::write_seed([](const char* file) {
    Part part;
    const RunKey key{"hybmss", 0.25, {2, 2, 2}};
    part.runs.push_back({key, "msm", "linear", true});
    part.rows.push_back({key, "case", "linear", "volume_change", 0.1, "1", {}, {}, 0.01});
    part.references.push_back(
        {.measure = "volume_change", .cells = {{1, 1, 1}, {2, 2, 2}}, .values = {1, 2}, .observed_order = 2});
    part.pictures.push_back({key, {0, 0, 0}, {0, 0, 1}, {}, {0, 0, 0, -1}});
    part.lines.push_back({key, 1, 1, {0.5}, {1, 2, 3, 4, 5, 6}});
    part.splits.push_back({key, 0.1, "volume_change", "1", 1});
    save_part(file, stamp, part);
  });
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::read_or_refuse<DamagedFile>([&] {
    const std::string_view bytes = fuzz::view(data, size);
    if (bytes != with_true_checksum(bytes)) fuzz::read_or_refuse<DamagedFile>([&] { load(bytes); });
    if (!load(with_true_checksum(bytes))) throw DamagedFile("no part, or one of another stamp");
  });
}
