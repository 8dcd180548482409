#include "comparisons/reproduce/paper_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "comparisons/judge/differences.h"
#include "comparisons/results/crack_picture.h"
#include "comparisons/results/records_json.h"
#include "problem/files/encoding.h"
#include "problem/files/files.h"
#include "problem/system/input_error.h"

namespace springproof {
namespace {

using nlohmann::json;

/// Unsigned little-endian numbers.
template <class T>
std::vector<T> little_endian(const json& base64_text) {
  const std::string bytes = from_base64(base64_text.get_ref<const std::string&>());
  std::vector<T> out(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t b = 0; b < sizeof(T); ++b)
      out[i] |= static_cast<T>(static_cast<T>(static_cast<unsigned char>(bytes[sizeof(T) * i + b])) << (8 * b));
  return out;
}

std::vector<float> floats_of(const json& base64_text) {
  std::vector<float> out;
  for (const std::uint32_t bits : little_endian<std::uint32_t>(base64_text)) out.push_back(std::bit_cast<float>(bits));
  return out;
}

std::vector<float> scaled_shorts(const json& j) {
  constexpr std::int16_t not_finite = -32768;
  const double scale = j.at("scale");
  std::vector<float> out;
  for (const std::uint16_t bits : little_endian<std::uint16_t>(j.at("base64"))) {
    const auto steps = static_cast<std::int16_t>(bits);
    out.push_back(steps == not_finite ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(scale * steps));
  }
  return out;
}

/// @throws std::out_of_range if a facet names a node that is not there.
std::vector<int> facets_of(const json& quads, std::size_t nodes) {
  std::vector<int> out;
  const auto add = [&](auto number) {
    if (number >= nodes) throw std::out_of_range(fmt::format("a facet names node {} of {}", number, nodes));
    out.push_back(static_cast<int>(number));
  };
  if (quads.at("type") == "uint16")
    for (const std::uint16_t n : little_endian<std::uint16_t>(quads.at("base64"))) add(n);
  else
    for (const std::uint32_t n : little_endian<std::uint32_t>(quads.at("base64"))) add(n);
  return out;
}

Picture picture_of(const json& j, const json& meshes) {
  Picture p;
  const json& mesh = meshes.at(j.at("mesh").get<std::size_t>());
  p.model = j.at("model");
  p.poisson_ratio = j.at("poisson_ratio");
  p.cells = j.at("cells").get<Cells>();
  p.surface = j.at("surface");
  p.rest = floats_of(mesh.at("rest"));
  p.displacement = scaled_shorts(j.at("displacement"));
  p.quads = facets_of(mesh.at("quads"), p.rest.size() / 3);
  if (p.displacement.size() != p.rest.size()) throw std::out_of_range("displacements of other nodes");
  return p;
}

/// Pictures of FOLDER/report.html by case ("golec_2019/torsion"): rest, displacement (to 1/65000 of its largest
/// component) and facets; none if there is no report.
/// @throws InputError if the file is no report.
std::map<std::string, std::vector<Picture>> read_pictures(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "report.html";
  const std::string page = text_of_file(file);
  if (page.empty()) return {};
  const std::string opening = "id=\"pictures-data\">";
  const std::size_t at = page.find(opening), end = page.find("</script>", at);
  try {
    if (end == std::string::npos) throw std::out_of_range("there are no pictures in it");
    const std::size_t from = at + opening.size();
    std::map<std::string, std::vector<Picture>> all;
    for (const json& result :
         json::parse(page.begin() + static_cast<long>(from), page.begin() + static_cast<long>(end))) {
      const std::string group = result.at("folder"), name = result.at("case");
      for (const json& j : result.at("pictures"))
        all[group.empty() ? name : group + '/' + name].push_back(picture_of(j, result.at("meshes")));
    }
    return all;
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: not the report of `springproof compare`: {}", file.string(), e.what()));
  }
}

/// Results have null for what is no number.
void nan_for_null(json& j) {
  if (j.is_null()) j = std::nan("");
  if (j.is_structured())
    for (json& item : j) nan_for_null(item);
}

/// Of [[published]] the remark says why ours differs; of [[expect]] with source "published" there is none.
std::vector<PrintedValue> printed_of(const json& result, const std::string& case_name, const std::vector<Row>& rows) {
  std::vector<PrintedValue> all;
  const auto add = [&](const json& j, const char* printed) {
    PrintedValue v{case_name,
                   j.at("model"),
                   j.at("poisson_ratio"),
                   j.value("cells", Cells{}),
                   j.at("measure"),
                   j.at("unit"),
                   j.at(printed),
                   j.at("computed").get<std::optional<double>>(),
                   {},
                   j.at("where"),
                   j.value("remark", "")};
    for (const Row& row : rows)
      if (row.measure == v.measure && same_poisson_ratio(row.poisson_ratio, v.poisson_ratio) && row.reference)
        v.fem = row.reference;
    all.push_back(std::move(v));
  };
  for (const json& check : result.at("checks"))
    if (check.at("source") == "published") add(check, "expected");
  for (const json& value : result.at("published")) add(value, "published");
  return all;
}

Shape shape_of(const Picture& p) {
  Shape shape;
  for (std::size_t i = 0; i + 2 < p.rest.size(); i += 3) {
    const Vec3 rest(p.rest[i], p.rest[i + 1], p.rest[i + 2]);
    shape.rest.push_back(rest);
    shape.displaced.push_back(rest + Vec3(p.displacement[i], p.displacement[i + 1], p.displacement[i + 2]));
  }
  for (std::size_t i = 0; i + 3 < p.quads.size(); i += 4)
    shape.facets.push_back({p.quads[i], p.quads[i + 1], p.quads[i + 2], p.quads[i + 3]});
  return shape;
}

/// What results call a case: its last folder and its name ("tables/table2_compression_5").
std::string name_in_results(const std::string& case_name) {
  const std::size_t name = case_name.rfind('/');
  const std::size_t folder =
      name == std::string::npos || name == 0 ? std::string::npos : case_name.rfind('/', name - 1);
  return folder == std::string::npos ? case_name : case_name.substr(folder + 1);
}

}  // namespace

void PaperResults::add(const std::filesystem::path& folder) try {
  const ResultsFolder found = read_results(folder);
  const json document = json::parse(text_of_file(folder / "results.json"));
  for (std::size_t i = 0; i < found.cases.size(); ++i) {
    const json& result = document.at("cases").at(i);
    json lines = result.at("lines");
    ReadCase one;
    for (const Row& row : found.rows)
      if (row.case_name == found.cases[i]) one.rows.push_back(row);
    one.printed = printed_of(result, found.cases[i], one.rows);
    nan_for_null(lines);
    lines.get_to(one.lines);
    for (const json& run : result.at("runs"))
      if (!run.at("ok").get<bool>())
        one.failed.push_back({run.at("model"), run.at("poisson_ratio"), run.at("message")});
    one.folder = folder;
    cases_[found.cases[i]] = std::move(one);
  }
} catch (const json::exception& e) {
  refuse_results(folder, e.what());
}

PaperResults::PaperResults(const std::vector<std::filesystem::path>& folders) {
  for (const std::filesystem::path& folder : folders) add(folder);
}

bool PaperResults::has(const std::string& case_name) const { return cases_.contains(name_in_results(case_name)); }

const PaperResults::ReadCase& PaperResults::read(const std::string& case_name) const {
  static const ReadCase none;
  const auto found = cases_.find(name_in_results(case_name));
  return found == cases_.end() ? none : found->second;
}

const Row* PaperResults::row(const std::string& case_name, const std::string& model, double poisson_ratio,
                             const std::string& measure, const std::optional<Cells>& cells) const {
  const Row* best = nullptr;
  for (const Row& row : rows(case_name)) {
    if (row.model != model || row.measure != measure || !same_poisson_ratio(row.poisson_ratio, poisson_ratio)) continue;
    if (cells ? row.cells == *cells : !best || cell_count(row.cells) < cell_count(best->cells)) best = &row;
  }
  return best;
}

std::vector<PrintedValue> PaperResults::printed(const std::string& case_name, const std::string& where) const {
  std::vector<PrintedValue> all;
  for (const PrintedValue& v : read(case_name).printed) {
    const bool longer =
        v.where.size() > where.size() && std::isdigit(static_cast<unsigned char>(v.where[where.size()]));
    if (v.where.starts_with(where) && !longer) all.push_back(v);
  }
  std::ranges::stable_sort(all, [](const PrintedValue& a, const PrintedValue& b) {
    return std::pair(a.poisson_ratio, cell_count(a.cells)) < std::pair(b.poisson_ratio, cell_count(b.cells));
  });
  return all;
}

std::string PaperResults::cracks(const std::string& case_name, const std::string& model) const {
  const Row* finest = nullptr;
  for (const Row& row : rows(case_name))
    if (row.model == model && (!finest || cell_count(row.cells) > cell_count(finest->cells))) finest = &row;
  if (!finest) return "";
  const std::filesystem::path file =
      read(case_name).folder / crack_file(case_name.substr(case_name.rfind('/') + 1), *finest);
  std::string svg = text_of_file(file);
  if (!svg.empty() && !is_crack_svg(svg))
    throw InputError(
        fmt::format("{}: is no drawing of cracks by `springproof compare` (a page with it could run what "
                    "others wrote; allowed: the file as it was written)",
                    file.string()));
  return svg;
}

std::string PaperResults::failure(const std::string& case_name, const std::string& model, double poisson_ratio) const {
  for (const FailedRun& run : read(case_name).failed)
    if (run.model == model && same_poisson_ratio(run.poisson_ratio, poisson_ratio))
      return run.message.substr(0, run.message.find(':'));
  return "";
}

const std::vector<Picture>& PaperResults::pictures(const std::string& case_name) const {
  const std::string key = name_in_results(case_name);
  const auto known = pictures_.find(key);
  if (known != pictures_.end()) return known->second;
  for (auto& [name, all] : read_pictures(read(case_name).folder)) pictures_[name] = std::move(all);
  return pictures_[key];
}

std::optional<Shape> PaperResults::shape(const std::string& case_name, const std::string& model, double poisson_ratio,
                                         const std::optional<Cells>& cells) const {
  if (!has(case_name)) return {};
  const Picture* best = nullptr;
  for (const Picture& p : pictures(case_name)) {
    if (p.model != model || p.surface != "cells" || !same_poisson_ratio(p.poisson_ratio, poisson_ratio)) continue;
    if (cells ? p.cells == *cells : !best || cell_count(p.cells) < cell_count(best->cells)) best = &p;
  }
  return best ? std::optional(shape_of(*best)) : std::nullopt;
}

}  // namespace springproof
