#include "meshes/mesher/script_files.h"

#include <string>
#include <string_view>
#include <vector>

#include "problem/processes/child.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 4096;

/// What stands between two of these marks on one line.
void add_strings(std::string_view text, char mark, std::vector<std::string>& strings) {
  for (std::size_t begin = text.find(mark); begin != std::string_view::npos; begin = text.find(mark, begin + 1)) {
    const std::size_t end = text.find_first_of(std::string{mark, '\n'}, begin + 1);
    if (end == std::string_view::npos || text[end] == '\n' || end - begin > longest_name) continue;
    strings.emplace_back(text.substr(begin + 1, end - begin - 1));
  }
}

/// Files in the folder whose names begin so.
void add_beginning_with(const fs::path& folder, const std::string& beginning, std::vector<fs::path>& files) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().filename().string().starts_with(beginning)) files.push_back(entry->path());
}

/// Files that the text may mean, there or not.
std::vector<fs::path> named_in(const std::string& text, const fs::path& folder) {
  std::vector<std::string> strings;
  for (const char mark : {'"', '\''}) add_strings(text, mark, strings);
  std::vector<fs::path> files;
  for (const std::string& name : strings) {
    const fs::path file = folder / name;
    const std::string last = file.filename().string();
    if (const auto percent = last.find('%'); percent != std::string::npos)
      add_beginning_with(file.parent_path(), last.substr(0, percent), files);
    else
      files.push_back(file);
  }
  return files;
}

void add(const fs::path& file, std::set<fs::path>& files) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return;
  const fs::path real = fs::canonical(file, error);
  if (error || !files.insert(real).second) return;
  for (const fs::path& other : named_in(text_of_file(real), file.parent_path())) add(other, files);
}

}  // namespace

std::set<fs::path> files_behind(const fs::path& body) {
  std::set<fs::path> files;
  add(body, files);
  fs::path options = body;
  add(options += ".opt", files);  // gmsh reads it with the body
  return files;
}

}  // namespace springproof
