#include "comparisons/sweep/find_cases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "meshes/mesher/mesher.h"
#include "meshes/mesher/mesher_exchange.h"
#include "problem/processes/child.h"
#include "problem/system/input_error.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

template <class Iterator>
std::vector<fs::path> toml_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".toml") files.push_back(entry->path());
  if (error) throw InputError(shortened(fmt::format("{}: cannot be read: {}", folder.string(), error.message())));
  std::ranges::sort(files);
  return files;
}

/// @throws InputError for a body, which has no loads.
const fs::path& no_body(const fs::path& file) {
  static const std::vector<std::string> unread = {".3mf", ".off",  ".vtk", ".vtu",    ".igs",   ".iges", ".fbx",
                                                  ".dae", ".gltf", ".glb", ".sldprt", ".blend", ".inp",  ".nas"};
  const auto& bodies = body_file_endings();
  const std::string ending = extension_of(file);
  if (std::ranges::find(unread, ending) != unread.end())
    throw InputError(shortened(
        fmt::format("{} is no case (allowed: NAME.toml); as bodies of cases {} files are read, and programs such as "
                    "MeshLab, Blender or FreeCAD convert to one of these",
                    file.string(), fmt::join(bodies, ", "))));
  if (std::ranges::find(bodies, ending) == bodies.end()) return file;
  throw InputError(shortened(fmt::format("{} is a body (allowed: a case, NAME.toml, in which [body] has geo = \"{}\")",
                                         file.string(), file.filename().string())));
}

fs::path experiments_folder() { return data_folder("experiments", SPRINGPROOF_EXPERIMENTS_DIR); }

}  // namespace

std::string case_name(const fs::path& file) {
  const fs::path relative = fs::proximate(fs::absolute(file), experiments_folder());
  return *relative.begin() == ".." ? file.stem().string() : (relative.parent_path() / relative.stem()).string();
}

std::vector<fs::path> built_in_cases() { return toml_files<fs::recursive_directory_iterator>(experiments_folder()); }

std::vector<fs::path> find_cases(const std::vector<std::string>& names) {
  std::vector<fs::path> cases;
  for (const std::string& name : names) {
    const fs::path built_in = experiments_folder() / name;
    std::vector<fs::path> found;
    std::string why;
    for (const fs::path& path : {fs::path(name), built_in, fs::path(built_in.string() + ".toml")}) {
      std::error_code error;
      const fs::file_status status = fs::status(path, error);
      if (fs::is_directory(status))
        found = toml_files<fs::directory_iterator>(path);
      else if (fs::exists(status))
        found = {no_body(path)};
      else if (error && status.type() != fs::file_type::not_found && why.empty())
        why = error.message() + "; ";  // a loop of links, too long a name
      if (!found.empty()) break;
    }
    if (found.empty())
      throw InputError(
          shortened(fmt::format("{}: {}no such case file, and no folder with case files (*.toml); `springproof list` "
                                "shows the built-in ones",
                                name, why)));
    for (const fs::path& file : found) {
      std::error_code ignored;
      if (std::ranges::none_of(cases, [&](const fs::path& c) { return c == file || fs::equivalent(c, file, ignored); }))
        cases.push_back(file);
    }
  }
  return cases;
}

fs::path find_case(const std::string& name) {
  const std::vector<fs::path> found = find_cases({name});
  if (found.size() > 1) throw InputError(fmt::format("{} is a folder of {} cases; name one", name, found.size()));
  return found.front();
}

Experiment only(const std::vector<double>& wanted, Experiment e) {
  if (wanted.empty()) return e;
  const auto left_out = [&](double nu) {
    return std::ranges::none_of(wanted, [&](double w) { return same_poisson_ratio(w, nu); });
  };
  const std::vector<double> has = e.settings();
  e.leave_out_settings(left_out);
  std::erase_if(e.expectations, [&](const Expectation& x) { return x.poisson_ratio && left_out(*x.poisson_ratio); });
  std::erase_if(e.published, [&](const PublishedValue& v) { return left_out(v.poisson_ratio); });
  if (e.settings().empty())
    throw InputError(fmt::format("{}: {}: none of those wanted (allowed: {})", e.file.string(), e.listed_words(),
                                 fmt::join(has, ", ")));
  return e;
}

Experiment finer(int times, Experiment e) {
  if (times == 1) return e;
  if (e.reference.cells[0] == 0 && e.reference.edge == 0)
    throw InputError(fmt::format(
        "--finer: {} leaves its reference grids to the program; give it [reference] cells or edge_m", e.file.string()));
  for (int& n : e.reference.cells)
    if (n > 1) n *= times;
  e.reference.edge /= times;
  return e;
}

}  // namespace springproof
