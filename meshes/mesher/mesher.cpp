#include "meshes/mesher/mesher.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <span>

#include "meshes/mesher/mesh_cache.h"
#include "meshes/mesher/mesher_exchange.h"
#include "problem/files/files.h"
#include "problem/processes/child.h"
#include "problem/system/progress.h"
#include "problem/system/streams.h"

namespace springproof {
namespace {

namespace fs = std::filesystem;

constexpr double most_cells = 5e6;

constexpr double smallest_scale = 1e-30, largest_scale = 1e30;  // as numbers of a case

[[noreturn]] void refuse(const fs::path& file, const std::string& message) {
  throw InputError(SourceLocation{file.string(), 0, 0}, message);
}

double time_limit() {
  const char* given = std::getenv("SPRINGPROOF_MESH_SECONDS");
  if (!given) return 300;
  char* end = nullptr;
  const double seconds = std::strtod(given, &end);
  if (end == given || *end != '\0' || !(seconds > 0) || !std::isfinite(seconds))
    throw InputError(fmt::format("SPRINGPROOF_MESH_SECONDS: '{}' is no time limit (allowed: seconds > 0)", given));
  return seconds;
}

/// Of an STL file, by its size: binary ones take 50 bytes each, those in words some 250.
double facets_in(const fs::path& stl) {
  std::error_code ignored;
  const auto bytes = static_cast<double>(fs::file_size(stl, ignored));
  char start[84] = {};
  std::ifstream(stl, std::ios::binary).read(start, sizeof start);
  std::uint32_t count = 0;
  std::memcpy(&count, start + 80, sizeof count);
  return bytes == 84 + 50.0 * count ? count : bytes / 250;
}

/// Checking facets against each other and thinning them out takes minutes from a million on, and some kB each.
void check_facets(const fs::path& stl) {
  constexpr double many = 5e5, seconds_each = 6e-5, bytes_each = 700;
  const double facets = facets_in(stl), seconds = seconds_each * facets, limit = time_limit();
  if (seconds > limit)
    refuse(stl, fmt::format("about {:.2g} facets (allowed: up to {:.2g}, as they take some {:.2g} s and the time limit "
                            "is {:g} s; thin the surface out, no "
                            "reference needs as many, or set SPRINGPROOF_MESH_SECONDS)",
                            facets, limit / seconds_each, seconds, limit));
  if (facets > many)
    to_stderr(
        "note: {}: about {:.2g} facets, which take some {:.2g} s and {:.2g} GB before they are meshed (fewer "
        "would do)\n",
        stl.string(), facets, seconds, 1e-9 * bytes_each * facets);
}

/// @param farthest the largest coordinate
void require_size(const fs::path& file, const Vec3& size, double farthest) {
  if (size.maxCoeff() >= smallest_body && size.maxCoeff() <= largest_body && farthest <= largest_body) return;
  refuse(file,
         fmt::format("the body spans {:.3g} x {:.3g} x {:.3g} m, up to {:.3g} m from the origin (allowed: a longest "
                     "side of {:g} to {:g} m, no further than {:g} m from the origin; size_m, or scale of a file)",
                     size[0], size[1], size[2], farthest, smallest_body, largest_body, largest_body));
}

/// The body itself.
MeshedBody of_sound_size(const fs::path& file, MeshedBody body) {
  const NodalVectors& x = body.mesh.nodes;
  const auto span = x.colwise().maxCoeff() - x.colwise().minCoeff();
  require_size(file, span.transpose(), x.cwiseAbs().maxCoeff());
  return body;
}

void check(const MeshRequest& r) {
  const auto& extensions = body_file_endings();
  const std::string extension = extension_of(r.file);
  if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    refuse(r.file,
           fmt::format("cannot read a body from a '{}' file (allowed: {}; programs such as MeshLab, Blender or FreeCAD "
                       "convert others to one of these)",
                       extension, fmt::join(extensions, ", ")));
  require_file(r.file, fmt::format("a body: {}", fmt::join(extensions, ", ")));
  if (extension == ".stl") check_facets(r.file);
  if (!r.size.isZero() && !(r.size.allFinite() && r.size.minCoeff() > 0))
    refuse(r.file, "size_m: three positive lengths are needed");
  if (r.cells != Cells{0, 0, 0} && *std::min_element(r.cells.begin(), r.cells.end()) < 1)
    refuse(r.file, "cells: three counts >= 1 are needed");
  if (const double cells = double(r.cells[0]) * r.cells[1] * r.cells[2]; cells > most_cells)
    refuse(r.file,
           fmt::format("cells: {} x {} x {} = {:.3g} cells (allowed: up to {:.0g}; a mesh takes some kB per cell)",
                       r.cells[0], r.cells[1], r.cells[2], cells, most_cells));
  if (!(r.edge >= 0) || !std::isfinite(r.edge))
    refuse(r.file, fmt::format("edge: {} m is no length (allowed: > 0)", r.edge));
  if (!(r.scale >= smallest_scale && r.scale <= largest_scale))
    refuse(r.file,
           fmt::format("scale: {} is no factor (allowed: {:g} to {:g})", r.scale, smallest_scale, largest_scale));
  if (!r.size.isZero()) require_size(r.file, r.size, r.size.maxCoeff());
  if (r.kind.vertices && extension != ".msh" && !is_surface_file(extension))
    refuse(r.file, "has no vertices of its own (allowed: .stl, .obj, .ply, .msh)");
  if (r.kind.closed && !is_surface_file(extension))
    refuse(r.file, "is no file of a surface (allowed: .stl, .obj, .ply)");
  if (r.edge == 0 && r.tetrahedra == 0 && !r.kind.vertices && !r.kind.closed && extension != ".geo" &&
      extension != ".msh")
    refuse(r.file, "edge: the length of the tetrahedra's edges is needed (allowed: > 0 [m])");
}

std::string list_of_bodies(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".geo") names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return fmt::format("{}", fmt::join(names, ", "));
}

fs::path built_in_bodies() { return data_folder("geo", SPRINGPROOF_GEO_DIR); }

/// @throws InputError at a script that is not built in, where such are not wanted.
void refuse_own_script(const Body& body, const fs::path& file) {
  if (!std::getenv("SPRINGPROOF_NO_SCRIPTS") || !body.is_script() || is_built_in(file)) return;
  const std::span other_endings = std::span(body_file_endings()).subspan(1);
  throw InputError(body.where,
                   fmt::format("body.geo: '{}' is a script, which may run any command, and --no-scripts is "
                               "set (allowed: {} files, and the built-in {})",
                               body.geo, fmt::join(other_endings, ", "), list_of_bodies(built_in_bodies())));
}

}  // namespace

bool is_built_in(const fs::path& file) {
  std::error_code ignored;
  return fs::equivalent(fs::weakly_canonical(file, ignored).parent_path(), built_in_bodies(), ignored);
}

fs::path find_geo(const Body& body, const fs::path& case_file) {
  const fs::path built_in = built_in_bodies();
  for (const fs::path& candidate : {case_file.parent_path() / body.geo, built_in / body.geo}) {
    std::error_code ignored;
    if (body.geo.empty() || !fs::is_regular_file(candidate, ignored)) continue;
    refuse_own_script(body, candidate);
    return candidate;
  }
  std::error_code ignored;
  if (const fs::path beside = case_file.parent_path() / body.geo; !body.geo.empty() && fs::exists(beside, ignored))
    throw InputError(body.where, fmt::format("body.geo: {} is {} (allowed: a file)", beside.string(),
                                             fs::is_directory(beside, ignored) ? "a folder" : "no regular file"));
  throw InputError(body.where, fmt::format("body.geo: no file '{}' beside the case file or among the built-in "
                                           "bodies (allowed: {})",
                                           body.geo, list_of_bodies(built_in)));
}

double size_ratio(const Mesh& coarse, const Mesh& fine) {
  return std::cbrt(double(fine.tetrahedra.size()) / double(coarse.tetrahedra.size()));
}

MeshedBody mesh_body(const MeshRequest& request) {
  check(request);
  const double seconds = time_limit();
  const fs::path program = find_program("springproof-mesh", "SPRINGPROOF_MESH_PROGRAM");
  if (program.empty())
    throw std::runtime_error(
        "the program springproof-mesh is neither beside this one nor named by SPRINGPROOF_MESH_PROGRAM");
  const MeshCache cache(request, program);
  if (std::optional<MeshedBody> kept = cache.find()) return of_sound_size(request.file, std::move(*kept));
  progress::detail("meshing " + request.file.filename().string());
  const TemporaryFolder folder;
  const fs::path question = folder.path / "request.cbor", answer = folder.path / "answer.cbor",
                 log = folder.path / "log";
  std::ofstream out(question, std::ios::binary);
  out << to_cbor(request);
  out.close();
  if (!out) folder.require_room();
  const ChildEnd end = run_child({program, {question.string(), answer.string()}, {}, log, log, seconds});
  if (end.kind == ChildEnd::out_of_time)
    refuse(request.file,
           fmt::format("meshing {} (choose a longer edge, or set SPRINGPROOF_MESH_SECONDS)", words_for(end, seconds)));
  if (!end.ok()) folder.require_room();
  if (!end.ok()) refuse(request.file, fmt::format("the mesher {} {}", words_for(end), trimmed(text_of_file(log))));
  try {
    const std::string bytes = text_of_file(answer);
    MeshedBody body = of_sound_size(request.file, answer_from_cbor(bytes));
    cache.keep(bytes);
    return body;
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(fmt::format("{}: {}", request.file.string(), e.what()));
  }
}

MeshedBody mesh_to_cut(MeshRequest request) {
  request.coarser = {reference_ratios.begin(), reference_ratios.end()};
  try {
    return mesh_body(request);
  } catch (const InputError&) {
    request.coarser.clear();
    return mesh_body(request);
  }
}

namespace {

/// Meshes what a process asks for but once.
MeshedBody meshed_once(const MeshRequest& request) {
  static std::mutex mutex;
  static std::map<std::string, MeshedBody> made;
  const std::string key = to_cbor(request) + line_of(request.file);
  {
    const std::lock_guard lock(mutex);
    if (const auto before = made.find(key); before != made.end()) return before->second;
  }
  MeshedBody body = mesh_body(request);
  const std::lock_guard lock(mutex);
  return made.emplace(key, std::move(body)).first->second;
}

}  // namespace

MeshedBody closed_surface(const fs::path& file, double scale) {
  return meshed_once({.file = file, .kind = {.closed = true}, .scale = scale});
}

Mesh mesh_geo(const fs::path& geo, const Vec3& size, const Cells& cells, MeshKind kind,
              const std::vector<std::string>& volumes) {
  require_file(geo, "a script for gmsh, NAME.geo");
  if (!size.allFinite() || !(size.minCoeff() > 0)) refuse(geo, "size_m: three positive lengths are needed");
  if (*std::min_element(cells.begin(), cells.end()) < 1) refuse(geo, "cells: three counts >= 1 are needed");
  return meshed_once({.file = geo, .size = size, .cells = cells, .kind = kind, .volumes = volumes}).mesh;
}

}  // namespace springproof
