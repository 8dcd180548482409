#include "comparisons/engines/engine_facts.h"

#include <fmt/format.h>

#include "comparisons/engines/engine_constants.h"

namespace springproof {
namespace {

constexpr double stated_reach = 1, stated_acceleration = 9.81;
constexpr std::array<int, 2> frame_rates = {60, 240};  // per second

struct KindOfSpring {
  const char* key;
  const char* label;
  std::array<double, 3> share;  ///< inside, on the surface, on an edge of the body; 0: not there
};
constexpr std::array<KindOfSpring, 3> spring_kinds = {{{"k_e", "compliance 1/k_e, cell edge", {1, 0.5, 0.25}},
                                                       {"k_f", "compliance 1/k_f, face diagonal", {1, 0.5, 0}},
                                                       {"k_c", "compliance 1/k_c, cube diagonal", {1, 0, 0}}}};
constexpr const char* spring_places[] = {"inside", "surface", "edge"};

double corner_tetrahedron(const EngineFacts& f) { return f.edge * f.edge * f.edge / 6; }

void add_compliances(const EngineFacts& f, std::vector<FactRow>& rows) {
  for (std::size_t kind = 0; kind < spring_kinds.size(); ++kind) {
    FactRow row{spring_kinds[kind].label, "m/N", {}};
    for (std::size_t place = 0; place < 3; ++place)
      if (const double k = f.inner[kind] * spring_kinds[kind].share[place]; k > 0) {
        row.facts.push_back(
            {fmt::format("/engines/compliance_m_N/{}/{}", spring_kinds[kind].key, spring_places[place]), 1 / k});
        row.note += (row.note.empty() ? "" : ", ") + std::string(spring_places[place]);
      }
    if (!row.facts.empty()) rows.push_back(row);
  }
}

void add_damping(const EngineFacts& f, std::vector<FactRow>& rows) {
  rows.push_back({"", "Hz", {{"/engines/implicit_euler/frequency_Hz", f.frequency}}});
  for (std::size_t i = 0; i < frame_rates.size(); ++i) {
    const std::string place = fmt::format("/engines/implicit_euler/damping/{}/", i);
    const double step = 1.0 / frame_rates[i];
    rows.push_back({"", "s", {{place + "time_step_s", step}}});
    rows.push_back({fmt::format("implicit Euler damps {:g} Hz in steps of 1/{} s by", f.frequency, frame_rates[i]),
                    "",
                    {{place + "zeta", implicit_euler_damping(f.frequency, step)}},
                    "of the critical, pi f dt"});
  }
}

}  // namespace

FactGroup facts_of(const EngineFacts& f) {
  FactGroup group{"for real-time engines (docs/engines.md)"};
  add_compliances(f, group.rows);
  const bool corrects = f.correction > 0;
  group.rows.push_back({corrects ? "constraint on 6 V of a sixth of a cell that adds kappa" : "",
                        "m^5/N",
                        {{"/engines/volume_compliance_m5_N",
                          corrects ? FactValue(volume_compliance(corner_tetrahedron(f), f.correction)) : FactValue()}},
                        "36 V / kappa; tetrahedra lock"});
  const BulletNeoHooke bullet = bullet_neo_hooke(f.material);
  group.rows.push_back({"Bullet's neo-Hooke, mu", "Pa", {{"/engines/bullet_neo_hooke/mu_Pa", bullet.mu}}, "4/3 G"});
  group.rows.push_back(
      {"Bullet's neo-Hooke, lambda", "Pa", {{"/engines/bullet_neo_hooke/lambda_Pa", bullet.lambda}}, "Lame's + 5/6 G"});
  add_damping(f, group.rows);
  group.rows.push_back({"", "m", {{"/engines/single_precision/reach_m", stated_reach}}});
  group.rows.push_back({"", "m/s^2", {{"/engines/single_precision/acceleration_m_s2", stated_acceleration}}});
  group.rows.push_back(
      {"single precision: least step",
       "s",
       {{"/engines/single_precision/least_time_step_s",
         least_single_precision_step(stated_reach, stated_acceleration)}},
       fmt::format("sqrt(1.2e-7 |x| / g), at |x| = {:g} m, g = {:g} m/s^2", stated_reach, stated_acceleration)});
  return group;
}

}  // namespace springproof
