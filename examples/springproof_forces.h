/* Forces of averaged springs (hybmss_avg) in whole and in cut cells, of measured cells, of HybMSS and its hourglass
 * correction in C99, for an engine or a shader that has a springs file (springproof export BODY --to springs) and
 * nothing else of springproof. SI units; nodes count from 0; a vector is three numbers in a row.  Every function adds
 * to the forces f [N] and returns its energy [J]; f may be null.  Equations: Golec et al. (2019); averaged springs:
 * docs/large_strain.md; cut cells and anchors: docs/cut_cells.md; the hourglass correction: docs/papers.md, section 4.
 */
#ifndef SPRINGPROOF_FORCES_H
#define SPRINGPROOF_FORCES_H

#include <math.h>
#include <stddef.h>

/* Signs of the corners of a cell: (0,0,0) (1,0,0) (1,1,0) (0,1,0) (0,0,1) (1,0,1) (1,1,1) (0,1,1) are -1 or +1. */
static const int sp_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/* One spring between nodes i and j: W = k/2 (L' - L)^2 (4.1). */
static double sp_spring(int i, int j, double k, double L, const double* x, double* f) {
  const double *a = x + 3 * i, *b = x + 3 * j;
  const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), stretch = length - L;
  for (int c = 0; f && c < 3; ++c) {
    const double pull = k * stretch / length * d[c];
    f[3 * i + c] += pull;
    f[3 * j + c] -= pull;
  }
  return 0.5 * k * stretch * stretch;
}

/* nodes: count x 2. */
static double sp_springs(size_t count, const int* nodes, const double* k, const double* L, const double* x, double* f) {
  double energy = 0;
  for (size_t s = 0; s < count; ++s) energy += sp_spring(nodes[2 * s], nodes[2 * s + 1], k[s], L[s], x, f);
  return energy;
}

static void sp_cross(const double* u, const double* v, double* w) {
  w[0] = u[1] * v[2] - u[2] * v[1];
  w[1] = u[2] * v[0] - u[0] * v[2];
  w[2] = u[0] * v[1] - u[1] * v[0];
}

/* Volume correction: W = V kappa psi(J), J = a . (b x c) / V with the mean edge vectors a, b, c of a cell (5.13),
 * (5.14); psi = 9/2 (J^(1/3) - 1)^2, or with `paper` (J - 1)^2 / 2 (5.1).  nodes: cells x 8; edge of every cell [m]. */
static double sp_volume(size_t cells, const int* nodes, double edge, double kappa, int paper, const double* x,
                        double* f) {
  const double V = edge * edge * edge;
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell) {
    const int* n = nodes + 8 * cell;
    double mean[3][3] = {{0}}, area[3][3]; /* mean edge vectors; b x c, c x a, a x b */
    for (int corner = 0; corner < 8; ++corner)
      for (int d = 0; d < 3; ++d)
        for (int c = 0; c < 3; ++c) mean[d][c] += sp_sign[corner][d] * x[3 * n[corner] + c] / 4;
    for (int d = 0; d < 3; ++d) sp_cross(mean[(d + 1) % 3], mean[(d + 2) % 3], area[d]);
    const double J = (mean[0][0] * area[0][0] + mean[0][1] * area[0][1] + mean[0][2] * area[0][2]) / V;
    const double root = cbrt(J);
    energy += V * kappa * (paper ? 0.5 * (J - 1) * (J - 1) : 4.5 * (root - 1) * (root - 1));
    if (!f) continue;
    const double slope = kappa * (paper ? J - 1 : 3 * (root - 1) / (root * root));
    for (int corner = 0; corner < 8; ++corner)
      for (int d = 0; d < 3; ++d)
        for (int c = 0; c < 3; ++c) f[3 * n[corner] + c] -= slope * sp_sign[corner][d] * area[d][c] / 4;
  }
  return energy;
}

/* Stiffness of the hourglass modes of a cell [N/m]: derived.hourglass_* of the file. */
struct sp_hourglass_stiffness {
  double bending, coupling, torsion, torsion_coupling;
};

/* Hourglass correction, linear in the displacements x - X: for small displacements without rotation.  Modes of unit
 * norm: u_p ~ xi_p xi_y (bending) and u_m ~ the product of the other two xi (torsion). */
static double sp_hourglass(size_t cells, const int* nodes, struct sp_hourglass_stiffness k, const double* X,
                           const double* x, double* f) {
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell) {
    const int* n = nodes + 8 * cell;
    double mode[3][3] = {{0}}, force[3][3] = {{0}}; /* [component][the axis that the mode does not contain] */
    for (int corner = 0; corner < 8; ++corner)
      for (int c = 0; c < 3; ++c)
        for (int out = 0; out < 3; ++out)
          mode[c][out] += sp_sign[corner][(out + 1) % 3] * sp_sign[corner][(out + 2) % 3] *
                          (x[3 * n[corner] + c] - X[3 * n[corner] + c]) / sqrt(8.0);
    for (int y = 0; y < 3; ++y) { /* u_p with xi_p xi_y does not contain q, u_q with xi_q xi_y not p */
      const int p = (y + 1) % 3, q = (y + 2) % 3;
      force[p][q] += k.bending * mode[p][q] + k.coupling * mode[q][p];
      force[q][p] += k.bending * mode[q][p] + k.coupling * mode[p][q];
    }
    const double twist = mode[0][0] + mode[1][1] + mode[2][2];
    for (int m = 0; m < 3; ++m) force[m][m] += k.torsion * mode[m][m] + k.torsion_coupling * twist;
    for (int c = 0; c < 3; ++c)
      for (int out = 0; out < 3; ++out) {
        energy += 0.5 * force[c][out] * mode[c][out];
        if (!f) continue;
        for (int corner = 0; corner < 8; ++corner)
          f[3 * n[corner] + c] -=
              force[c][out] * sp_sign[corner][(out + 1) % 3] * sp_sign[corner][(out + 2) % 3] / sqrt(8.0);
      }
  }
  return energy;
}

/* laws.averaged_springs of the file: moduli [Pa], hourglass springs [1]. */
enum sp_curve { SP_HENCKY, SP_NEO_HOOKE, SP_NEO_HOOKE_ISOCHORIC };
struct sp_averaged {
  enum sp_curve curve;
  double shear_modulus, lame_lambda;
  double bending, coupling, torsion, twist, warping;
};

/* Energy density W [Pa] of a deformation gradient F (row by row), and P = dW/dF; infinite if F turns a cell inside out.
 */
static double sp_strain_energy(struct sp_averaged law, double F[3][3], double P[3][3]) {
  const double G = law.shear_modulus, K = law.lame_lambda + 2 * G / 3;
  double cofactor[3][3], C[3][3], I1 = 0, I2, CC = 0, W, of_F, of_FC = 0, of_cofactor;
  for (int i = 0; i < 3; ++i) sp_cross(F[(i + 1) % 3], F[(i + 2) % 3], cofactor[i]);
  const double J = F[0][0] * cofactor[0][0] + F[0][1] * cofactor[0][1] + F[0][2] * cofactor[0][2];
  if (!(J > 0)) return INFINITY;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      C[i][j] = F[0][i] * F[0][j] + F[1][i] * F[1][j] + F[2][i] * F[2][j];
      CC += C[i][j] * C[i][j];
      if (i == j) I1 += C[i][i];
    }
  I2 = (I1 * I1 - CC) / 2;
  const double e = log(J), m = pow(J, -2.0 / 3), n = m * m;
  if (law.curve == SP_NEO_HOOKE) {
    W = G / 2 * (I1 - 3 - 2 * e) + law.lame_lambda / 2 * e * e;
    of_F = G;
    of_cofactor = law.lame_lambda * e - G;
  } else if (law.curve == SP_NEO_HOOKE_ISOCHORIC) {
    W = G / 2 * (m * I1 - 3) + K / 2 * (J - 1) * (J - 1);
    of_F = G * m;
    of_cofactor = K * (J - 1) * J - G * m * I1 / 3;
  } else { /* lengths of edges and areas of faces: Hencky's law */
    const double y = (m * I1 + n * I2 - 6) / 4, s = G / 2 * (1 - y / 3 + 2 * y * y / 15);
    W = G * y * (1 - y / 6 + 2 * y * y / 45) + K / 2 * e * e;
    of_F = s * (m + n * I1);
    of_FC = -s * n;
    of_cofactor = K * e - s * (m * I1 + 2 * n * I2) / 3;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      P[i][j] = of_F * F[i][j] + of_FC * (F[i][0] * C[0][j] + F[i][1] * C[1][j] + F[i][2] * C[2][j]) +
                of_cofactor / J * cofactor[i][j];
  return W;
}

/* The part of a cell that the body fills, by its moments [1]; xi is the place in the cell, -1/2 to 1/2, <.> the mean
 * over that part: its share of the cell, <xi_i>, <xi_j xi_k> and <xi_i^2> - <xi_i>^2. */
struct sp_part {
  double fraction, mean[3], mixed[3], variance[3];
};

/* cells.fraction, .mean, .mixed, .variance of the file; fraction = null: all cells are full. */
struct sp_parts {
  const double *fraction, *mean, *mixed, *variance;
};

static struct sp_part sp_part_of(struct sp_parts all, size_t cell) {
  struct sp_part part = {1, {0, 0, 0}, {0, 0, 0}, {1 / 12.0, 1 / 12.0, 1 / 12.0}};
  if (!all.fraction) return part;
  part.fraction = all.fraction[cell];
  for (int i = 0; i < 3; ++i) {
    part.mean[i] = all.mean[3 * cell + i];
    part.mixed[i] = all.mixed[3 * cell + i];
    part.variance[i] = all.variance[3 * cell + i];
  }
  return part;
}

/* Forces w [N] of the hourglass springs, whose energy is v . w / 2, of v [m], by pattern and axis.  The first three
 * patterns are taken at the centroid of the part, the springs weighted with its second moments. */
static void sp_hourglass_springs(struct sp_averaged law, double edge, struct sp_part part, double v[4][3],
                                 double w[4][3]) {
  const double unit = part.fraction * law.shear_modulus * edge / 2;
  double rho[3], c[3][3]; /* second moments over those of a full cell; the patterns at the centroid */
  for (int m = 0; m < 3; ++m) {
    rho[m] = fmax(12 * part.variance[m], 0.1);
    for (int j = 0; j < 3; ++j) c[m][j] = v[m][j] + part.mean[m] * v[3][j];
  }
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    w[k][l] = unit * rho[j] * (law.bending * c[k][l] + law.coupling * c[l][k]);
    w[l][k] = unit * rho[j] * (law.bending * c[l][k] + law.coupling * c[k][l]);
    w[j][j] = unit * (law.torsion * (rho[k] * (c[j][j] + c[l][l]) + rho[l] * (c[j][j] + c[k][k])) +
                      law.twist * (rho[k] + rho[l]) / 2 * c[j][j]);
  }
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    w[3][j] = unit / 4 * law.warping * (0.3 * rho[k] * rho[l] + rho[j] * (rho[k] + rho[l])) / 2.3 * v[3][j];
    for (int m = 0; m < 3; ++m) w[3][j] += part.mean[m] * w[m][j];
  }
}

/* How a cell is deformed: F the mean deformation gradient of its filled part, q the corners' positions in the patterns
 * h (yz, zx, xy, xyz) that F does not see, v = F^T q. */
struct sp_state {
  double g[8][3], h[8][4], F[3][3], q[3][4], v[4][3];
};

static struct sp_state sp_state_of(double edge, struct sp_part part, const int n[8], const double* x) {
  struct sp_state a = {{{0}}, {{0}}, {{0}}, {{0}}, {{0}}};
  for (int corner = 0; corner < 8; ++corner) {
    const int* s = sp_sign[corner];
    for (int i = 0; i < 3; ++i) { /* g: mean gradient of the corner's trilinear weight */
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      a.h[corner][i] = s[j] * s[k] / 2.0;
      a.g[corner][i] =
          s[i] / edge * (0.25 + (s[j] * part.mean[j] + s[k] * part.mean[k]) / 2 + s[j] * s[k] * part.mixed[i]);
    }
    a.h[corner][3] = s[0] * s[1] * s[2];
    for (int i = 0; i < 3; ++i) {
      const double at = x[3 * n[corner] + i];
      for (int j = 0; j < 3; ++j) a.F[i][j] += at * a.g[corner][j];
      for (int m = 0; m < 4; ++m) a.q[i][m] += at * a.h[corner][m];
    }
  }
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) a.v[m][j] += a.F[i][j] * a.q[i][m];
  return a;
}

/* From w = dW/dv, and dW/dF beside it. */
static void sp_add_cell(const struct sp_state* a, double of_F[3][3], double w[4][3], const int n[8], double* f) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double stress = of_F[i][j];
      for (int m = 0; m < 4; ++m) stress += a->q[i][m] * w[m][j];
      for (int corner = 0; corner < 8; ++corner) {
        f[3 * n[corner] + i] -= stress * a->g[corner][j];
        for (int m = 0; m < 4; ++m) f[3 * n[corner] + i] -= a->h[corner][m] * a->F[i][j] * w[m][j];
      }
    }
}

/* Averaged springs of one cell with the corners n: W = V w(F) + v . w / 2, V the volume of the filled part.  For any
 * strain and rotation. */
static double sp_averaged_cell(struct sp_averaged law, double edge, struct sp_part part, const int n[8],
                               const double* x, double* f) {
  struct sp_state a = sp_state_of(edge, part, n, x);
  const double V = part.fraction * edge * edge * edge;
  double P[3][3], w[4][3];
  sp_hourglass_springs(law, edge, part, a.v, w);
  double energy = V * sp_strain_energy(law, a.F, P);
  for (int m = 0; m < 4; ++m)
    for (int j = 0; j < 3; ++j) energy += 0.5 * a.v[m][j] * w[m][j];
  for (int i = 0; f && i < 3; ++i)
    for (int j = 0; j < 3; ++j) P[i][j] *= V;
  if (f) sp_add_cell(&a, P, w, n, f);
  return energy;
}

/* Eigenvectors of a symmetric matrix as the columns of V, by Jacobi's rotations; A's diagonal gets the eigenvalues. */
static void sp_eigenvectors(double A[3][3], double V[3][3]) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) V[i][j] = i == j;
  for (int turn = 0; turn < 30; ++turn) {
    const int p = turn % 3, q = (p + 1) % 3;
    if (fabs(A[p][q]) <= 1e-17 * (fabs(A[p][p]) + fabs(A[q][q]))) continue;
    const double theta = (A[q][q] - A[p][p]) / (2 * A[p][q]);
    const double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; ++k) {
      const double a = A[k][p], b = A[k][q], u = V[k][p], v = V[k][q];
      A[k][p] = c * a - s * b, A[k][q] = s * a + c * b;
      V[k][p] = c * u - s * v, V[k][q] = s * u + c * v;
    }
    for (int k = 0; k < 3; ++k) {
      const double a = A[p][k], b = A[q][k];
      A[p][k] = c * a - s * b, A[q][k] = s * a + c * b;
    }
  }
}

/* A measured cell: y = (edge log U, v), U^2 = F^T F; log U as xx, yy, zz, 2 yz, 2 zx, 2 xy, v by pattern and axis; V
 * the eigenvectors of C = F^T F, C then has its eigenvalues. */
static const int sp_strain_of[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};
struct sp_stretched {
  double C[3][3], V[3][3], y[18];
};

static struct sp_stretched sp_stretched_of(const struct sp_state* a, double edge) {
  struct sp_stretched at = {{{0}}, {{0}}, {0}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) at.C[i][j] += a->F[k][i] * a->F[k][j];
  sp_eigenvectors(at.C, at.V);
  for (int e = 0; e < 6; ++e)
    for (int k = 0; k < 3; ++k)
      at.y[e] += (e < 3 ? 0.5 : 1) * edge * log(at.C[k][k]) * at.V[sp_strain_of[e][0]][k] * at.V[sp_strain_of[e][1]][k];
  for (int m = 0; m < 12; ++m) at.y[6 + m] = a->v[m / 3][m % 3];
  return at;
}

/* s = M y; form: 171 numbers of laws.measured_cells.form_N_m, the lower triangle of M row by row [N/m].  Returns y . s
 * / 2. */
static double sp_form(const double* form, const double y[18], double s[18]) {
  double energy = 0;
  for (int i = 0; i < 18; ++i) s[i] = 0;
  for (int i = 0; i < 18; ++i)
    for (int j = 0; j <= i; ++j, ++form) {
      s[i] += *form * y[j];
      if (j < i) s[j] += *form * y[i];
    }
  for (int i = 0; i < 18; ++i) energy += 0.5 * s[i] * y[i];
  return energy;
}

/* From s = dW/dy. */
static void sp_add_stretched(const struct sp_state* a, const struct sp_stretched* at, double edge, const double s[18],
                             const int n[8], double* f) {
  double S[3][3], w[4][3], of_F[3][3] = {{0}};
  for (int e = 0; e < 6; ++e)
    S[sp_strain_of[e][0]][sp_strain_of[e][1]] = S[sp_strain_of[e][1]][sp_strain_of[e][0]] = edge * s[e];
  for (int m = 0; m < 12; ++m) w[m / 3][m % 3] = s[6 + m];
  for (int p = 0; p < 3; ++p)
    for (int q = 0; q < 3; ++q) { /* in axes of the eigenvectors: times the divided difference of log(C) / 2 */
      const double t = at->C[p][p] / at->C[q][q] - 1;
      double along = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) along += at->V[i][p] * S[i][j] * at->V[j][q];
      along *= (t == 0 ? 1 : log1p(t) / t) / (2 * at->C[q][q]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k) of_F[i][j] += 2 * a->F[i][k] * at->V[k][p] * along * at->V[j][q];
    }
  sp_add_cell(a, of_F, w, n, f);
}

/* W = y . M y / 2; infinite if the cell is inside out. */
static double sp_measured_cell(const double* form, double edge, struct sp_part part, const int n[8], const double* x,
                               double* f) {
  struct sp_state a = sp_state_of(edge, part, n, x);
  double s[18], normal[3];
  sp_cross(a.F[0], a.F[1], normal);
  if (!(normal[0] * a.F[2][0] + normal[1] * a.F[2][1] + normal[2] * a.F[2][2] > 0)) return INFINITY;
  struct sp_stretched at = sp_stretched_of(&a, edge);
  const double energy = sp_form(form, at.y, s);
  if (f) sp_add_stretched(&a, &at, edge, s, n, f);
  return energy;
}

/* Branches of a material that relaxes, relaxation of the file: an overstrain Q of each follows Q' + Q / time = E', E
 * the strains of a cell: the deviator of Green-Lagrange's strain, row by row, and the v of sp_state. */
enum { SP_STRAINS = 21 };
struct sp_branches {
  size_t count;
  const double *share, *time;
  struct sp_averaged
      cells;          /* shear_modulus and hourglass springs of the branches; curve and lame_lambda are not read */
  const double* form; /* of measured cells in their place; else null */
};

/* A step of branch b to the strains E, of so many numbers, from those of `state`: its Q there, sum += share Q. */
static const double* sp_advance_branch(struct sp_branches all, size_t b, int strains, const double* E, double dt,
                                       double* state, double* sum) {
  double* Q = state + SP_STRAINS * (1 + b);
  const double ratio = dt / all.time[b], phi = ratio > 0 ? -expm1(-ratio) / ratio : 1;
  for (int i = 0; i < strains; ++i) {
    Q[i] = exp(-ratio) * Q[i] + phi * (E[i] - state[i]);
    sum[i] += all.share[b] * Q[i];
  }
  return Q;
}

/* v without the mean of its first three. */
static void sp_without_volume(double v[18]) {
  const double mean = (v[0] + v[1] + v[2]) / 3;
  for (int i = 0; i < 3; ++i) v[i] -= mean;
}

/* sp_relaxing_cell of a measured cell: E is its y without the mean of the first three, the last numbers are unused. */
static double sp_relaxing_measured(struct sp_branches all, const double* form, double edge, struct sp_part part,
                                   const int n[8], const double* x, double dt, double* state, double* f) {
  struct sp_state a = sp_state_of(edge, part, n, x);
  struct sp_stretched at = sp_stretched_of(&a, edge);
  double sum[18] = {0}, s[18], energy = 0;
  sp_without_volume(at.y);
  for (size_t b = 0; b < all.count; ++b)
    energy += all.share[b] * sp_form(form, sp_advance_branch(all, b, 18, at.y, dt, state, sum), s);
  for (int i = 0; i < 18; ++i) state[i] = at.y[i];
  sp_form(form, sum, s);
  sp_without_volume(s);
  if (f) sp_add_stretched(&a, &at, edge, s, n, f);
  return energy;
}

/* Advances the branches of a cell by a step of dt [s] that ends at x, exactly for strains that change evenly, and adds
 * their forces there.  state: SP_STRAINS * (1 + count) numbers, the strains and each branch's Q; zeros: relaxed at
 * rest; dt = INFINITY: relaxed at x.  Returns the energy of the branches. */
static double sp_relaxing_cell(struct sp_branches all, double edge, struct sp_part part, const int n[8],
                               const double* x, double dt, double* state, double* f) {
  struct sp_state a = sp_state_of(edge, part, n, x);
  const double V = part.fraction * edge * edge * edge;
  double E[SP_STRAINS], sum[SP_STRAINS] = {0}, trace = -3, energy = 0;
  for (int i = 0; i < 9; ++i) trace += a.F[i / 3][i % 3] * a.F[i / 3][i % 3];
  for (int i = 0; i < 9; ++i) {
    E[i] = (i % 4 == 0 ? -1 - trace / 3 : 0) / 2;
    for (int k = 0; k < 3; ++k) E[i] += a.F[k][i / 3] * a.F[k][i % 3] / 2;
  }
  for (int m = 0; m < 12; ++m) E[9 + m] = a.v[m / 3][m % 3];
  for (size_t b = 0; b < all.count; ++b) {
    const double* Q = sp_advance_branch(all, b, SP_STRAINS, E, dt, state, sum);
    double w[4][3], of_v[4][3], twice = 0;
    for (int i = 0; i < 9; ++i) twice += 2 * all.cells.shear_modulus * V * Q[i] * Q[i];
    for (int m = 0; m < 12; ++m) of_v[m / 3][m % 3] = Q[9 + m];
    sp_hourglass_springs(all.cells, edge, part, of_v, w);
    for (int m = 0; m < 12; ++m) twice += Q[9 + m] * w[m / 3][m % 3];
    energy += all.share[b] * twice / 2;
  }
  double v[4][3], w[4][3], P[3][3] = {{0}};
  for (int i = 0; i < SP_STRAINS; ++i) state[i] = E[i];
  for (int m = 0; m < 12; ++m) v[m / 3][m % 3] = sum[9 + m];
  sp_hourglass_springs(all.cells, edge, part, v, w);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) P[i][j] += 2 * all.cells.shear_modulus * V * a.F[i][k] * sum[3 * k + j];
  if (f) sp_add_cell(&a, P, w, n, f);
  return energy;
}

/* Of all cells; edges: of each.  states: cells x SP_STRAINS * (1 + count).  In explicit steps: once a step, with f. */
static double sp_relaxing(size_t cells, const int* nodes, const double* edges, struct sp_parts parts,
                          struct sp_branches all, const double* x, double dt, double* states, double* f) {
  double energy = 0;
  for (size_t c = 0; c < cells; ++c)
    if (all.form)
      energy += sp_relaxing_measured(all, all.form + 171 * c, edges[c], sp_part_of(parts, c), nodes + 8 * c, x, dt,
                                     states + SP_STRAINS * (1 + all.count) * c, f);
    else
      energy += sp_relaxing_cell(all, edges[c], sp_part_of(parts, c), nodes + 8 * c, x, dt,
                                 states + SP_STRAINS * (1 + all.count) * c, f);
  return energy;
}

/* Of all cells of one size; form: cells x 171. */
static double sp_measured(size_t cells, const int* nodes, double edge, struct sp_parts parts, const double* form,
                          const double* x, double* f) {
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell)
    energy += sp_measured_cell(form + 171 * cell, edge, sp_part_of(parts, cell), nodes + 8 * cell, x, f);
  return energy;
}

/* Of all cells, each with its edge; nodes: cells x 8.  Carried nodes are put into their places before (sp_carry), and
 * the forces on them handed back after it (sp_hand_back). */
static double sp_averaged_sizes(size_t cells, const int* nodes, const double* edges, struct sp_parts parts,
                                struct sp_averaged law, const double* x, double* f) {
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell)
    energy += sp_averaged_cell(law, edges[cell], sp_part_of(parts, cell), nodes + 8 * cell, x, f);
  return energy;
}

/* Of cells of several materials; laws: laws.averaged_springs of the file and those of its regions, material:
 * cells.material. */
static double sp_averaged_materials(size_t cells, const int* nodes, double edge, struct sp_parts parts,
                                    const struct sp_averaged* laws, const int* material, const double* x, double* f) {
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell)
    energy += sp_averaged_cell(laws[material[cell]], edge, sp_part_of(parts, cell), nodes + 8 * cell, x, f);
  return energy;
}

/* Whether a bond is stiffer along some axes: then it turns with its cells. */
static int sp_bond_turns(const double K[9]) {
  for (int i = 0; i < 9; ++i)
    if (K[i] != (i % 4 == 0 ? K[0] : 0)) return 1;
  return 0;
}

/* Bonds between the cells of two materials: W = v . K v / 2, v the gap g, the mean of the first eight nodes of a bond
 * less that of the others, or, where K is no multiple of 1, F^T g, F the mean deformation gradient of both cells.
 * nodes, weights: count x 16; K: count x 9 [N/m]; edge of the cells [m]. */
static double sp_bonds(size_t count, const int* nodes, const double* weights, const double* K, double edge,
                       const double* x, double* f) {
  double energy = 0;
  for (size_t b = 0; b < count; ++b) {
    const int turns = sp_bond_turns(K + 9 * b);
    double g[3] = {0}, F[3][3] = {{0}}, force[3] = {0}, v[3] = {0};
    for (int c = 0; c < 3; ++c) F[c][c] = !turns;
    for (int n = 0; n < 16; ++n) {
      const double* at = x + 3 * nodes[16 * b + n];
      for (int c = 0; c < 3; ++c) {
        g[c] += (n < 8 ? 1 : -1) * weights[16 * b + n] * at[c];
        for (int j = 0; turns && j < 3; ++j) F[c][j] += at[c] * sp_sign[n % 8][j] / (8 * edge);
      }
    }
    for (int i = 0; i < 3; ++i)
      for (int c = 0; c < 3; ++c) v[i] += F[c][i] * g[c];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) force[i] += K[9 * b + 3 * i + j] * v[j];
      energy += 0.5 * force[i] * v[i];
    }
    for (int n = 0; f && n < 16; ++n) {
      double along = 0;
      for (int j = 0; turns && j < 3; ++j) along += sp_sign[n % 8][j] / (8 * edge) * force[j];
      for (int c = 0; c < 3; ++c) {
        const double of_gap = F[c][0] * force[0] + F[c][1] * force[1] + F[c][2] * force[2];
        f[3 * nodes[16 * b + n] + c] -= (n < 8 ? 1 : -1) * weights[16 * b + n] * of_gap + along * g[c];
      }
    }
  }
  return energy;
}

/* Nodes on edges and faces of larger cells, carried.nodes and .by of the file: each is in the mean of four.  by: count
 * x 4. */
static void sp_carry(size_t count, const int* nodes, const int* by, double* x) {
  for (size_t k = 0; k < count; ++k)
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (size_t n = 4 * k; n < 4 * k + 4; ++n) sum += x[3 * by[n] + c];
      x[3 * nodes[k] + c] = sum / 4;
    }
}

static void sp_hand_back(size_t count, const int* nodes, const int* by, double* f) {
  for (size_t k = count; k-- > 0;)
    for (int c = 0; c < 3; ++c) {
      for (size_t n = 4 * k; n < 4 * k + 4; ++n) f[3 * by[n] + c] += f[3 * nodes[k] + c] / 4;
      f[3 * nodes[k] + c] = 0;
    }
}

/* Of all cells of one size. */
static double sp_averaged_cut(size_t cells, const int* nodes, double edge, struct sp_parts parts,
                              struct sp_averaged law, const double* x, double* f) {
  double energy = 0;
  for (size_t cell = 0; cell < cells; ++cell)
    energy += sp_averaged_cell(law, edge, sp_part_of(parts, cell), nodes + 8 * cell, x, f);
  return energy;
}

/* The same of full cells. */
static double sp_averaged(size_t cells, const int* nodes, double edge, struct sp_averaged law, const double* x,
                          double* f) {
  const struct sp_parts full = {0, 0, 0, 0};
  return sp_averaged_cut(cells, nodes, edge, full, law, x, f);
}

/* Anchors by which a support holds a patch: W = d.K d/2, d = sum_a w_a x_a - point, anchors.NAME of the file.  nodes,
 * weights: count x 8; K: count x 9; points: where they are held. */
static double sp_anchors(size_t count, const int* nodes, const double* weights, const double* K, const double* points,
                         const double* x, double* f) {
  double energy = 0;
  for (size_t a = 0; a < count; ++a) {
    double d[3];
    for (int c = 0; c < 3; ++c) {
      d[c] = -points[3 * a + c];
      for (size_t n = 8 * a; n < 8 * a + 8; ++n) d[c] += weights[n] * x[3 * nodes[n] + c];
    }
    for (int c = 0; c < 3; ++c) {
      const double force = K[9 * a + 3 * c] * d[0] + K[9 * a + 3 * c + 1] * d[1] + K[9 * a + 3 * c + 2] * d[2];
      energy += 0.5 * force * d[c];
      for (size_t n = 8 * a; f && n < 8 * a + 8; ++n) f[3 * nodes[n] + c] -= weights[n] * force;
    }
  }
  return energy;
}

/* Adds to `mass` what the anchors of a support have of it in steps of dt: sp_step divides by it, gravity does not act
 * on it.  Of a support that moves, its acceleration times this is one more force. */
static void sp_support_mass(size_t count, const int* nodes, const double* weights, const double* K, double dt,
                            double* mass) {
  for (size_t a = 0; a < count; ++a) {
    double sum = 0, k = 0;
    for (size_t r = 9 * a; r < 9 * a + 9; r += 3) k = fmax(k, fabs(K[r]) + fabs(K[r + 1]) + fabs(K[r + 2]));
    for (size_t n = 8 * a; n < 8 * a + 8; ++n) sum += fabs(weights[n]);
    for (size_t n = 8 * a; n < 8 * a + 8; ++n) mass[nodes[n]] += dt * dt / 4 * k * fabs(weights[n]) * sum;
  }
}

/* The same of the masses at nodes. */
static void sp_hand_back_mass(size_t count, const int* nodes, const int* by, double* mass) {
  for (size_t k = count; k-- > 0;) {
    for (size_t n = 4 * k; n < 4 * k + 4; ++n) mass[by[n]] += mass[nodes[k]] / 4;
    mass[nodes[k]] = 0;
  }
}

/* One step of semi-implicit Euler, v += dt f / m, x += dt v, with damping in proportion to the mass [1/s], implicit.
 * Stable at rest for dt up to derived.safe_time_step_s.  Carried nodes, of no mass, stay: sp_carry. */
static void sp_step(size_t nodes, const double* mass, const double* f, double dt, double damping, double* x,
                    double* v) {
  for (size_t i = 0; i < 3 * nodes; ++i) {
    if (mass[i / 3] == 0) continue;
    v[i] = (v[i] + dt * f[i] / mass[i / 3]) / (1 + dt * damping);
    x[i] += dt * v[i];
  }
}

#endif
