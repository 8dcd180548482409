#include "comparisons/live/live.h"

#include <array>
#include <exception>

#include "comparisons/live/live_body.h"

namespace {

using namespace springproof;

constexpr int panels = 3;

struct Panel {
  std::string name;
  int digits = 0;
  std::unique_ptr<LiveModel> model;
};

struct Page {
  std::unique_ptr<LiveBody> body;
  std::vector<float> rest;
  std::array<Panel, panels> panel;
  std::string message;
};

Page& page() {
  static Page page;
  return page;
}

template <class F>
int tried(F f) {
  page().message.clear();
  try {
    f();
    return 0;
  } catch (const std::exception& e) {
    page().message = e.what();
    return 1;
  }
}

void take(LiveBody&& body) {
  for (Panel& p : page().panel) p = {};
  page().body = std::make_unique<LiveBody>(std::move(body));
  page().rest.clear();
  for (const Vec3& p : page().body->surface.points)
    for (int d = 0; d < 3; ++d) page().rest.push_back(static_cast<float>(p[d]));
  for (const std::string& note : page().body->notes) page().message += note + "\n";
}

template <class F>
void for_all(F f) {
  for (Panel& p : page().panel)
    if (p.model) f(*p.model);
}

Precision precision_of(const std::string& model, int digits) {
  if (digits == 0) return sufficient_precision(model);
  return digits == 32 ? Precision::float32 : Precision::float64;
}

LiveModel& model(int panel) { return *page().panel[panel].model; }

}  // namespace

int live_body(const float* points, int point_count, const unsigned short* facets, const unsigned char* parts,
              int facet_count, double cells) {
  return tried([&] {
    Surface surface;
    std::vector<LivePart> kinds;
    for (int n = 0; n < point_count; ++n)
      surface.points.emplace_back(points[3 * n], points[3 * n + 1], points[3 * n + 2]);
    for (int t = 0; t < facet_count; ++t) {
      surface.triangles.push_back({facets[3 * t], facets[3 * t + 1], facets[3 * t + 2]});
      kinds.push_back(static_cast<LivePart>(parts[t]));
    }
    take(live_body(std::move(surface), std::move(kinds), cells));
  });
}

int live_stl(const char* bytes, int size, double cells) {
  return tried([&] { take(live_stl({bytes, static_cast<std::size_t>(size)}, cells)); });
}

const char* live_message(void) { return page().message.c_str(); }

int live_model(int panel, const char* name, double poisson_ratio, double youngs_modulus, double density, int digits) {
  return tried([&] {
    const IsotropicMaterial material = {youngs_modulus, poisson_ratio, density};
    check(material);
    Panel& p = page().panel[panel];
    if (p.model && p.name == name && p.digits == digits) return p.model->set_material(material);
    p.model = std::make_unique<LiveModel>(*page().body, name, material, precision_of(name, digits));
    p.name = name;
    p.digits = digits;
  });
}

void live_rest(void) {
  for_all([](LiveModel& m) { m.rest(); });
}
void live_grab(int point) {
  for_all([&](LiveModel& m) { m.grab(point); });
}
void live_pull_to(double x, double y, double z) {
  for_all([&](LiveModel& m) { m.pull_to({x, y, z}); });
}
void live_load(double x, double y, double z) {
  for_all([&](LiveModel& m) { m.load({x, y, z}); });
}

int live_advance(int panel, double duration, double damping) { return model(panel).advance(duration, damping); }

int live_cells(void) { return static_cast<int>(page().body->mesh.hexahedra.size()); }
int live_nodes(void) { return static_cast<int>(page().body->mesh.nodes.rows()); }
int live_points(void) { return static_cast<int>(page().body->surface.points.size()); }
int live_facets(void) { return static_cast<int>(page().body->surface.triangles.size()); }
const int* live_facet_points(void) { return page().body->surface.triangles.front().data(); }
const float* live_rest_positions(void) { return page().rest.data(); }
const float* live_positions(int panel) { return model(panel).surface_positions().data(); }
const float* live_dilatation(int panel) { return model(panel).surface_dilatation().data(); }
const double* live_node_positions(int panel) { return model(panel).positions().data(); }

double live_number(int panel, int number) {
  const LiveModel& m = model(panel);
  switch (number) {
    case live_time_step:
      return m.time_step();
    case live_volume_change:
      return m.volume_change();
    case live_least_volume:
      return m.least_volume();
    case live_kinetic_energy:
      return m.kinetic_energy();
    case live_unbalanced:
      return m.unbalanced();
    case live_frequency:
      return m.frequency();
    case live_rescues:
      return m.rescues();
    case live_pull:
      return m.pulling().norm();
    default:
      return 0;
  }
}
