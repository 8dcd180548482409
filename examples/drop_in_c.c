/* Lets a body of averaged springs fall on a plane: C99 and a springs file (springproof export BODY --to springs --out
 * FILE.json), nothing else.  The plane pushes vertices of the true surface, which pass the force on to the nodes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "springproof_forces.h"

static char text[1 << 27];

/* The numbers after the key in a section of the file, which has each key in a line of its own. */
static double* numbers(const char* section, const char* key, size_t* count) {
  const char* at = strstr(text, section);
  if (!at || !(at = strstr(at, key))) return NULL;
  double* values = malloc(strcspn(at, "\n") * sizeof *values);
  *count = 0;
  for (at = strchr(at, ':') + 1; *at && *at != '\n'; ++at) {
    char* end;
    const double value = strtod(at, &end);
    if (end != at) values[(*count)++] = value, at = end - 1;
  }
  return values;
}

static int* whole(const char* section, const char* key, size_t* count) {
  const double* values = numbers(section, key, count);
  int* out = malloc(*count * sizeof *out);
  for (size_t i = 0; i < *count; ++i) out[i] = (int)values[i];
  return out;
}

int main(int argc, char** argv) {
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (!file) return fprintf(stderr, "usage: drop_in_c FILE.json\n"), 2;
  text[fread(text, 1, sizeof text - 1, file)] = 0;
  if (strstr(text, "\n \"carried\"")) return fprintf(stderr, "cells of several sizes: forces_in_c.cpp shows how\n"), 2;
  if (strstr(text, "\n \"bonds\"")) return fprintf(stderr, "several materials: forces_in_c.cpp shows how\n"), 2;
  if (!strstr(text, "\n  \"averaged_springs\"")) return fprintf(stderr, "no averaged springs: forces_in_c.cpp shows springs\n"), 2;
  const char *nodes = "\n \"nodes\"", *cells = "\n \"cells\"", *surface = "\n \"surface\"";
  if (strstr(text, "\"proportions\"")) return fprintf(stderr, "boxes: examples/springs.py has them\n"), 2;
  size_t n, n3, c8, vertices, one;
  const double *X = numbers(nodes, "\"position_m\"", &n3), *mass = numbers(nodes, "\"mass_kg\"", &n);
  const int* corners = whole(cells, "\"nodes\"", &c8);
  const struct sp_parts parts = {numbers(cells, "\"fraction\"", &one), numbers(cells, "\"mean\"", &one),
                                 numbers(cells, "\"mixed\"", &one), numbers(cells, "\"variance\"", &one)};
  const double edge = *numbers(cells, "\"edge_m\"", &one), dt = 0.9 * *numbers("\"derived\"", "\"safe", &one);
  const char* keys[] = {"\"shear_mod", "\"lame_lam", "\"bending", "\"coupling", "\"torsion", "\"twist", "\"warping"};
  double *a[7], *x = malloc(n3 * sizeof *x), *v = calloc(n3, sizeof *v), *f = malloc(n3 * sizeof *f);
  for (int i = 0; i < 7; ++i) a[i] = numbers("\"averaged_springs\"", keys[i], &one);
  const struct sp_averaged law = {SP_HENCKY, *a[0], *a[1], *a[2], *a[3], *a[4], *a[5], *a[6]};
  const double *vertex = numbers(surface, "\"position_m\"", &one), *weight = numbers(surface, "\"weights\"", &one);
  const int *first = whole(surface, "\"first\"", &vertices), *node = whole(surface, "\"nodes\"", &one);

  double low = INFINITY, high = -INFINITY, M = 0, energy, start = 0, off = 0, fallen = 0, rebound = 0, time = 0;
  memcpy(x, X, n3 * sizeof *x);
  for (size_t s = 2; s < 3 * (vertices - 1); s += 3) low = fmin(low, vertex[s]), high = fmax(high, vertex[s]);
  for (size_t i = 0; i < n; ++i) M += mass[i];
  const double g = 9.81, size = high - low, floor = low - 0.1 * size;
  for (; time < 3 * sqrt(0.2 * size / g); time += dt) {
    double height = 0;
    for (size_t i = 0; i < n3; ++i) f[i] = i % 3 == 2 ? -g * mass[i / 3] : 0;
    energy = sp_averaged_cut(c8 / 8, corners, edge, parts, law, x, f);
    for (size_t s = 0; s + 1 < vertices; ++s) { /* a spring at each vertex below the plane, soft for the step */
      double z = vertex[3 * s + 2] - floor, per_mass = 0;
      for (int e = first[s]; e < first[s + 1]; ++e) z += weight[e] * (x[3 * node[e] + 2] - X[3 * node[e] + 2]);
      for (int e = first[s]; e < first[s + 1]; ++e) per_mass += weight[e] * weight[e] / mass[node[e]];
      const double k = z < 0 ? 0.02 / (per_mass * dt * dt) : 0;
      for (int e = first[s]; e < first[s + 1]; ++e) f[3 * node[e] + 2] -= k * z * weight[e];
      energy += k * z * z / 2;
    }
    for (size_t i = 0; i < n3; ++i) { /* the velocity of a step is half a step behind the positions */
      const double now = v[i] + dt / 2 * f[i] / mass[i / 3], up = i % 3 == 2 ? x[i] - X[i] : 0;
      energy += mass[i / 3] * (now * now / 2 + g * up);
      height += mass[i / 3] * up / M;
    }
    if (time == 0) start = energy;
    off = fmax(off, fabs(energy - start) / (M * g * 0.1 * size));
    rebound = height < fallen ? fallen = height : fmax(rebound, height);
    sp_step(n, mass, f, dt, 0, x, v);
  }
  if (!isfinite(off)) return fprintf(stderr, "the motion diverged: a smaller step, or a stiffer body, which the fall presses less\n"), 1;
  printf("falls by %.4g m, rebounds by %.4g m, energy within %.1e of the fall's\n", -fallen, rebound - fallen, off);
  return rebound - fallen > -fallen / 4 && off < 1e-3 ? 0 : 1;
}
