// What the motion of a bar tells: frequency and damping of a mode, spin that is kept.
#pragma once

#include <optional>

#include "comparisons/bench/engine_adapter.h"

namespace springproof::bench {

struct Vibration {
  double frequency = 0;  ///< [Hz]
  double damping = 0;    ///< share of the critical
  double periods = 0;    ///< seen
};

/// A free vibration from its samples: the frequency from the passages through rest of the tip's displacement along `d`,
/// the damping from the mean kinetic energy of the first and of the last period, which beats of other modes hardly
/// change.  Nothing if fewer than three periods are seen, or if they differ by more than a quarter.
std::optional<Vibration> vibration_of(const std::vector<EngineSample>& samples, const Vec3& d);

/// Angular momentum about z at the end over that at the start.
double spin_kept(const std::vector<EngineSample>& samples);

}  // namespace springproof::bench
