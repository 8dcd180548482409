#include "meshes/surface/surface_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "problem/system/input_error.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t header_bytes = 84, facet_bytes = 50;

[[noreturn]] void refuse(const fs::path& file, const std::string& message, int line = 0, int column = 0) {
  throw InputError(SourceLocation{file.string(), line, column}, message);
}

void add_facet(Surface& surface, const std::array<Vec3, 3>& corners) {
  const int first = static_cast<int>(surface.points.size());
  surface.points.insert(surface.points.end(), corners.begin(), corners.end());
  surface.triangles.push_back({first, first + 1, first + 2});
}

// Binary: 80 bytes of anything, the count, then per facet 12 floats (normal, corners) and two bytes.

std::uint32_t facet_count(std::string_view bytes) {
  std::uint32_t count;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

/// @throws InputError if the body is so far from the origin that coordinates of 32 bits do not resolve it.
void require_resolution(const fs::path& file, const Surface& surface) {
  constexpr double coarsest = 1e-3;  // steps of coordinates over the body's size
  const Box box = bounding_box(surface);
  const double farthest = std::max(box.low.cwiseAbs().maxCoeff(), box.high.cwiseAbs().maxCoeff());
  const auto f = static_cast<float>(farthest);
  const double step = std::nextafter(f, INFINITY) - f, size = (box.high - box.low).maxCoeff();
  if (step <= coarsest * size) return;
  refuse(file, fmt::format("coordinates near {:.9g} have steps of {:.2g} in a binary STL file, and the body is {:.3g} "
                           "long (allowed: {:g} of that; move the body to the origin before it is written)",
                           farthest, step, size, coarsest));
}

Surface read_binary(const fs::path& file, std::string_view bytes) {
  const std::size_t count = facet_count(bytes);
  if (count == 0) refuse(file, "has no facets");
  Surface surface;
  surface.points.reserve(3 * count);
  surface.triangles.reserve(count);
  for (std::size_t f = 0; f < count; ++f) {
    std::array<float, 12> numbers;
    std::memcpy(numbers.data(), bytes.data() + header_bytes + facet_bytes * f, sizeof numbers);
    if (!std::all_of(numbers.begin() + 3, numbers.end(), [](float x) { return std::isfinite(x); }))
      refuse(file, fmt::format("facet {}: a coordinate is not a finite number (corners ({}, {}, {}), "
                               "({}, {}, {}), ({}, {}, {}))",
                               f + 1, numbers[3], numbers[4], numbers[5], numbers[6], numbers[7], numbers[8],
                               numbers[9], numbers[10], numbers[11]));
    const auto corner = [&](int c) { return Vec3(numbers[3 * c + 3], numbers[3 * c + 4], numbers[3 * c + 5]); };
    add_facet(surface, {corner(0), corner(1), corner(2)});
  }
  require_resolution(file, surface);
  return surface;
}

// ASCII.

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; }

bool same_word(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

/// Words and lines of a text; lines end with LF, CR LF or CR.
class Words {
 public:
  explicit Words(std::string_view text)
      : at_(text.data()), end_(text.data() + text.size()), word_(at_), line_begin_(at_) {}

  /// Empty at the end of the text.
  std::string_view next() {
    for (; at_ != end_ && is_space(*at_); ++at_) count_line();
    word_ = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {word_, static_cast<std::size_t>(at_ - word_)};
  }
  /// Without spaces at its ends.
  std::string_view rest_of_line() {
    const char* begin = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* end = at_;
    while (begin != end && is_space(*begin)) ++begin;
    while (begin != end && is_space(end[-1])) --end;
    return {begin, static_cast<std::size_t>(end - begin)};
  }
  int line() const { return line_; }  ///< of the last word, from 1
  int column() const { return static_cast<int>(word_ - line_begin_) + 1; }
  bool at_end() const { return at_ == end_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void count_line() {
    if (*at_ != '\n' && !(*at_ == '\r' && (at_ + 1 == end_ || at_[1] != '\n'))) return;
    ++line_;
    line_begin_ = at_ + 1;
  }

  const char *at_, *end_, *word_, *line_begin_;
  int line_ = 1;
};

class AsciiReader {
 public:
  AsciiReader(const fs::path& file, std::string_view text) : file_(file), words_(text) {}

  Surface read() {
    for (std::string_view word = words_.next(); !word.empty(); word = words_.next()) read_solid(word);
    if (surface_.triangles.empty()) refuse(file_, "has no facets");
    if (surface_.parts.size() < 2) surface_.parts.clear();
    return std::move(surface_);
  }

 private:
  void read_solid(std::string_view word) {
    if (!same_word(word, "solid")) wrong("solid", word);
    const std::string name(words_.rest_of_line());
    const std::size_t first = surface_.triangles.size();
    while (true) {
      word = words_.next();
      if (same_word(word, "endsolid")) {
        words_.rest_of_line();
        return name_part(name, first);
      }
      if (word.empty()) refuse_here(fmt::format("cut off after facet {}: no 'endsolid'", surface_.triangles.size()));
      if (!same_word(word, "facet")) wrong("facet' or 'endsolid", word);
      read_facet();
    }
  }

  /// The facets from `first` on are a part of the surface, if its solid has a name.
  void name_part(const std::string& name, std::size_t first) {
    if (name.empty()) return;
    for (std::size_t t = first; t < surface_.triangles.size(); ++t) surface_.parts[name].push_back(static_cast<int>(t));
  }

  void read_facet() {
    expect("normal");
    for (int c = 0; c < 3; ++c)
      if (words_.next().empty()) cut_off();  // not read: the corners say it, and some programs write "nan" here
    expect("outer");
    expect("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect("vertex");
      for (int c = 0; c < 3; ++c) corner[c] = number();
    }
    expect("endloop");
    expect("endfacet");
    add_facet(surface_, corners);
  }

  double number() {
    const std::string_view word = words_.next();
    if (word.empty()) cut_off();
    const bool plus = word[0] == '+' && !word.starts_with("+-");  // from_chars takes no plus
    const char *begin = word.data() + plus, *end = word.data() + word.size();
    double value = 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error == std::errc::result_out_of_range)
      value = std::strtod(std::string(word).c_str(), nullptr);  // 0 or infinite
    if ((error == std::errc::invalid_argument || stop != end) && words_.at_end()) cut_off();
    if (error == std::errc::invalid_argument || stop != end)
      refuse_here(fmt::format("facet {}: '{}' is not a number", number_of_facet(), word));
    if (!std::isfinite(value))
      refuse_here(fmt::format("facet {}: coordinate '{}' is not a finite number", number_of_facet(), word));
    return value;
  }

  void expect(const char* wanted) {
    const std::string_view word = words_.next();
    if (word.empty()) cut_off();
    if (!same_word(word, wanted)) wrong(wanted, word);
  }
  [[noreturn]] void wrong(const char* wanted, std::string_view found) {
    if (words_.at_end()) cut_off();  // within a word
    refuse_here(fmt::format("facet {}: '{}' where '{}' should stand", number_of_facet(), found.substr(0, 40), wanted));
  }
  [[noreturn]] void cut_off() { refuse_here(fmt::format("cut off within facet {}", number_of_facet())); }
  [[noreturn]] void refuse_here(const std::string& message) { refuse(file_, message, words_.line(), words_.column()); }
  std::size_t number_of_facet() const { return surface_.triangles.size() + 1; }

  const fs::path& file_;
  Words words_;
  Surface surface_;
};

// Which of the two, or neither.

bool is_binary_by_size(std::string_view bytes) {
  return bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * std::size_t{facet_count(bytes)};
}

bool is_text(std::string_view bytes) {
  const std::string_view first = bytes.substr(0, 1024);
  return std::none_of(first.begin(), first.end(),
                      [](char c) { return static_cast<unsigned char>(c) < ' ' && !(c >= '\t' && c <= '\r'); });
}

struct Signature {
  std::string_view bytes;
  const char* kind;
};
constexpr Signature signatures[] = {
    {"\x89PNG", "a PNG picture"},
    {"\xff\xd8\xff", "a JPEG picture"},
    {"PK\x03\x04", "a ZIP archive (3MF is one)"},
    {"\x1f\x8b", "gzip-compressed"},
    {"%PDF", "a PDF document"},
    {"glTF", "a glTF model"},
    {"ply", "a PLY model"},
    {"ISO-10303-21", "a STEP model"},
    {"$MeshFormat", "a gmsh mesh"},
    {"<", "XML or HTML"},
};

/// The rest of the bytes: neither ASCII nor binary of the size its header says.
[[noreturn]] void refuse_kind(const fs::path& file, std::string_view bytes) {
  for (const Signature& signature : signatures)
    if (bytes.starts_with(signature.bytes)) refuse(file, fmt::format("is no STL file but {}", signature.kind));
  if (is_text(bytes)) {
    Words words(bytes);
    refuse(file, fmt::format("is no STL file: its first word is '{}' (ASCII STL begins with 'solid')",
                             words.next().substr(0, 40)));
  }
  if (bytes.size() < header_bytes)
    refuse(file, fmt::format("is no STL file: {} bytes (binary STL has {} and {} per facet)", bytes.size(),
                             header_bytes, facet_bytes));
  const std::size_t rest = bytes.size() - header_bytes;
  const std::string extra = rest % facet_bytes ? fmt::format(" and {} bytes", rest % facet_bytes) : "";
  refuse(file, fmt::format(
                   "the header of the binary STL says {} facets, but the file's size is that of {} facets{}: it is cut "
                   "off or no STL file; write it again",
                   facet_count(bytes), rest / facet_bytes, extra));
}

}  // namespace

Surface parse_stl(std::string_view bytes, const fs::path& file) {
  if (is_binary_by_size(bytes)) return read_binary(file, bytes);
  std::string_view text = bytes;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // byte order mark
  Words words(text);
  const std::string_view first = words.next();
  if (is_text(text) && first.empty()) refuse(file, "is empty");
  if (is_text(text) && same_word(first, "solid")) return AsciiReader(file, text).read();
  refuse_kind(file, bytes);
}

}  // namespace springproof
