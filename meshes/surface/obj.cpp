#include "meshes/surface/surface_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::filesystem::path& file) : text_(text), file_(file) {}

  Surface read() {
    while (!text_.empty()) {
      ++line_;
      const std::size_t end = text_.find('\n');
      read_line(text_.substr(0, end));
      text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    }
    line_ = 0;
    if (surface_.triangles.empty()) refuse("has no facets (allowed: lines 'f i j k' of a closed surface)");
    if (surface_.parts.size() < 2) surface_.parts.clear();
    return std::move(surface_);
  }

 private:
  static std::string_view next_word(std::string_view& rest) {
    constexpr std::string_view spaces = " \t\r";
    const std::size_t begin = rest.find_first_not_of(spaces);
    if (begin == std::string_view::npos) return rest = {};
    const std::size_t end = std::min(rest.find_first_of(spaces, begin), rest.size());
    const std::string_view word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
  }

  void read_line(std::string_view rest) {
    rest = rest.substr(0, rest.find('#'));
    const std::string_view key = next_word(rest);
    if (key == "v") read_point(rest);
    if (key == "f") read_facet(rest);
    if (key != "g" && key != "o") return;
    names_.clear();
    for (std::string_view name = next_word(rest); !name.empty(); name = next_word(rest)) names_.emplace_back(name);
  }

  void read_point(std::string_view rest) {
    Vec3 point;
    for (double& x : point) {
      const std::string_view word = next_word(rest);
      const auto [stop, error] = std::from_chars(word.data() + word.starts_with('+'), word.data() + word.size(), x);
      if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(x))
        refuse(fmt::format("vertex {}: '{}' is no finite number (allowed: v x y z)", surface_.points.size() + 1, word));
    }
    surface_.points.push_back(point);
  }

  /// "7", "7/1", "7//3" or "7/1/3"; -1 is the last vertex so far.
  int corner(std::string_view word) {
    const auto count = static_cast<int>(surface_.points.size());
    int number = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool whole = error == std::errc{} && (stop == word.data() + word.size() || *stop == '/');
    const int index = number < 0 ? count + number : number - 1;
    if (!whole || index < 0 || index >= count)
      refuse(fmt::format("facet: '{}' names none of the {} vertices before it (allowed: 1 to {}, or -1 for the last)",
                         word, count, count));
    return index;
  }

  void read_facet(std::string_view rest) {
    std::vector<int> corners;
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest))
      corners.push_back(corner(word));
    if (corners.size() < 3) refuse(fmt::format("facet: has {} corners (allowed: 3 or more)", corners.size()));
    for (std::size_t c = 2; c < corners.size(); ++c) {
      for (const std::string& name : names_)
        surface_.parts[name].push_back(static_cast<int>(surface_.triangles.size()));
      surface_.triangles.push_back({corners[0], corners[c - 1], corners[c]});
    }
  }

  [[noreturn]] void refuse(const std::string& message) const {
    throw InputError(SourceLocation{file_.string(), line_, line_ > 0 ? 1 : 0}, message);
  }

  std::string_view text_;
  const std::filesystem::path& file_;
  int line_ = 0;
  std::vector<std::string> names_;
  Surface surface_;
};

}  // namespace

Surface read_obj(const std::filesystem::path& file) {
  return ObjReader(read_named_file(file, "an OBJ file, NAME.obj"), file).read();
}

}  // namespace springproof
