#include "comparisons/results/crack_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "problem/files/file_name.h"
#include "problem/files/files.h"

namespace springproof {
namespace {

constexpr double picture_width = 2000;  // units of the drawing
constexpr std::array<const char*, 4> crack_colours = {"#67000d", "#cb181d", "#f16913", "#fdae6b"};  // ColorBrewer

// The pieces of a drawing.
constexpr char svg_heading[] =
    "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-20 -20 {0:g} {0:g}\" fill=\"none\" stroke-linecap=\"round\">"
    "<rect x=\"-20\" y=\"-20\" width=\"{0:g}\" height=\"{0:g}\" fill=\"#fff\"/>";
constexpr char grey_path[] = "<path stroke=\"#b4bcc5\" stroke-width=\"3\" d=\"", path_end[] = "\"/>",
               svg_end[] = "</svg>\n";

std::string crack_path(const char* colour) {
  return fmt::format("<path stroke=\"{}\" stroke-width=\"7\" d=\"", colour);
}

/// The box around all strokes.
struct Frame {
  double left = 0, bottom = 0, size = 1;

  explicit Frame(const std::vector<Stroke>& springs, const std::vector<Stroke>& cracks) {
    std::vector<double> x, y;
    for (const auto* strokes : {&springs, &cracks})
      for (const Stroke& s : *strokes) {
        x.insert(x.end(), {s.x0, s.x1});
        y.insert(y.end(), {s.y0, s.y1});
      }
    if (x.empty()) return;
    const auto [x_min, x_max] = std::ranges::minmax_element(x);
    const auto [y_min, y_max] = std::ranges::minmax_element(y);
    size = std::max({*x_max - *x_min, *y_max - *y_min, 1e-300});
    left = (*x_min + *x_max - size) / 2;
    bottom = (*y_min + *y_max - size) / 2;
  }

  long across(double x) const { return std::lround((x - left) / size * picture_width); }
  long down(double y) const { return std::lround((1 - (y - bottom) / size) * picture_width); }

  std::string path(const Stroke& s) const {
    return fmt::format("M{} {}L{} {}", across(s.x0), down(s.y0), across(s.x1), down(s.y1));
  }
};

}  // namespace

std::string crack_svg(const std::vector<Stroke>& springs, const std::vector<Stroke>& cracks) {
  const Frame frame(springs, cracks);
  std::array<std::string, crack_colours.size()> drawn;
  for (const Stroke& s : cracks) {
    const auto age = static_cast<std::size_t>(std::clamp(s.age, 0.0, 1.0) * crack_colours.size());
    drawn[std::min(age, crack_colours.size() - 1)] += frame.path(s);
  }
  std::string grey;
  for (const Stroke& s : springs) grey += frame.path(s);
  std::string out = fmt::format(svg_heading, picture_width + 40) + grey_path + grey + path_end;
  for (std::size_t i = 0; i < drawn.size(); ++i)
    if (!drawn[i].empty()) out += crack_path(crack_colours[i]) + drawn[i] + path_end;
  return out + svg_end;
}

bool is_crack_svg(std::string_view text) {
  const auto take = [&](std::string_view expected) {
    if (!text.starts_with(expected)) return false;
    text.remove_prefix(expected.size());
    return true;
  };
  const auto take_strokes = [&] {
    text.remove_prefix(std::min(text.find_first_not_of("ML -0123456789"), text.size()));
    return take(path_end);
  };
  if (!take(fmt::format(svg_heading, picture_width + 40)) || !take(grey_path) || !take_strokes()) return false;
  for (const char* colour : crack_colours)
    if (take(crack_path(colour)) && !take_strokes()) return false;
  return text == svg_end;
}

std::string crack_file(const std::string& case_name, const RunKey& key) {
  return file_name(
             fmt::format("{}-cracks-{}-{}-nu{}", case_name, key.model, cells_text(key.cells), key.poisson_ratio)) +
         ".svg";
}

void write_crack_pictures(const std::vector<CaseResult>& results, const std::filesystem::path& folder) {
  for (const CaseResult& result : results)
    for (const CrackRecord& c : result.cracks) write_file(folder / crack_file(result.experiment.name, c), c.svg);
}

}  // namespace springproof
