// The live page's interface in C: three models of one body beside each other, called `panels`.
// A function that can fail returns 0, or 1 and the reason in live_message(); notes about a body are there too.
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/// A closed surface: 3 coordinates per point [m], 3 point numbers and one part (0 free, 1 held, 2 pulled) per facet.
int live_body(const float* points, int point_count, const unsigned short* facets, const unsigned char* parts,
              int facet_count, double cells);
/// The bytes of an STL file.
int live_stl(const char* bytes, int size, double cells);
const char* live_message(void);

/// Puts a model of the table at rest into a panel; a panel that has one keeps its motion if the name is the same.
/// `digits`: 32 or 64, the bits of the kernels' numbers; 0: those that suffice (sufficient_precision()).
int live_model(int panel, const char* name, double poisson_ratio, double youngs_modulus, double density, int digits);
void live_rest(void);

void live_grab(int point);                        ///< of the surface, by all panels; -1: let go
void live_pull_to(double x, double y, double z);  ///< [m]
void live_load(double x, double y, double z);     ///< force on the pulled facets [N]

int live_advance(int panel, double duration, double damping);  ///< @return steps done

int live_cells(void);
int live_nodes(void);
int live_points(void);
int live_facets(void);
const int* live_facet_points(void);            ///< three per facet
const float* live_rest_positions(void);        ///< of the surface, 3 per point [m]
const float* live_positions(int panel);        ///< of the surface, 3 per point [m]
const float* live_dilatation(int panel);       ///< V'/V - 1 about each point
const double* live_node_positions(int panel);  ///< of the nodes, 3 per node [m]

/// Numbers about a panel.
enum LiveNumber {
  live_time_step,       ///< that the next steps will take [s]
  live_volume_change,   ///< of the body [1]
  live_least_volume,    ///< smallest V'/V of a cell [1]
  live_kinetic_energy,  ///< [J]
  live_unbalanced,      ///< [N]
  live_frequency,       ///< angular, of the motion that the load makes [1/s]
  live_rescues,         ///< unstable states taken back
  live_pull,            ///< force of the grip [N]
};
double live_number(int panel, int number);

#ifdef __cplusplus
}
#endif
