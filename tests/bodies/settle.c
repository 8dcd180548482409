/* Lets a held body of averaged springs swing under its weight until it rests, by springproof_forces.h alone. */
#include <string.h>

#include "springproof_forces.h"

struct body {
  size_t nodes, cells, anchors, held;
  const double *mass, *weight; /* [kg]; weight: where gravity acts */
  const int* corners;
  double edge;
  struct sp_parts parts; /* of cut cells; else null */
  struct sp_averaged law;
  const int* anchored; /* of cut cells: 8 a support's anchor */
  const double *weights, *k, *points;
  const int* fixed; /* of blocks: nodes that a support holds */
};

/* x: at the start and at the end.  Returns the last kinetic energy over the largest. */
double settle(const struct body* b, const double* g, double dt, double damping, long steps, double* x, double* divided,
              double* v, double* f) {
  double largest = 0, kinetic = 0;
  memcpy(divided, b->mass, b->nodes * sizeof *divided);
  sp_support_mass(b->anchors, b->anchored, b->weights, b->k, dt, divided);
  for (long step = 0; step < steps; ++step) {
    for (size_t i = 0; i < 3 * b->nodes; ++i) f[i] = g[i % 3] * b->weight[i / 3] - damping * b->mass[i / 3] * v[i];
    sp_averaged_cut(b->cells, b->corners, b->edge, b->parts, b->law, x, f);
    sp_anchors(b->anchors, b->anchored, b->weights, b->k, b->points, x, f);
    for (size_t h = 0; h < b->held; ++h)
      for (int c = 0; c < 3; ++c) f[3 * b->fixed[h] + c] = 0;
    sp_step(b->nodes, divided, f, dt, 0, x, v);
    kinetic = 0;
    for (size_t i = 0; i < 3 * b->nodes; ++i) kinetic += b->mass[i / 3] * v[i] * v[i];
    if (kinetic > largest) largest = kinetic;
  }
  return kinetic / largest;
}
