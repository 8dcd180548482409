// Closed surfaces of known volume, and STL files of them.
#pragma once

#include <filesystem>

#include "meshes/surface/surface.h"

namespace springproof::test {

/// Icosahedron cut `times` times, its points on the sphere about zero: 20 * 4^times facets, volume below 4/3 pi r^3 by
/// O(h^2).
Surface sphere(double radius, int times);

/// Of parallels and meridians: needles at the poles, 2 * around * (rings - 1) facets.
Surface globe(double radius, int rings, int around);

/// sphere() with each point moved along its radius by up to +-noise * radius.
Surface noisy_sphere(double radius, int times, double noise, unsigned seed);

/// About the z axis, 2 * around * across facets; volume tends to 2 pi^2 R r^2.
Surface torus(double ring_radius, double tube_radius, int around, int across);

/// Tube round a trefoil knot (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t): 2 * around * across facets; volume tends to
/// pi r^2 trefoil_length().
Surface trefoil(double tube_radius, int around, int across);
double trefoil_length();

/// As of a scanner: bumps on an ellipsoid with half axes 3, 2, 1.5, points at random, facets of uneven size
/// (about 2/3 of 20 * 4^times), noise along the radius up to +-noise.  Its volume tends to scan_volume().
Surface scan(int times, double noise, unsigned seed);
double scan_volume();

/// [0, size] with n x n x 2 facets on each side.
Surface box(const Vec3& size, int n);

/// Second surface beside or in the first one.
Surface both(const Surface& a, const Surface& b);
Surface moved(Surface surface, double scale, const Vec3& by);
Surface turned(Surface surface);

void write_stl_ascii(const std::filesystem::path& file, const Surface& surface);
void write_stl_binary(const std::filesystem::path& file, const Surface& surface);

}  // namespace springproof::test
