// Springs by which a support holds a patch of a cut body, and by which its materials hold each other.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "meshes/voxels/cut_cells.h"
#include "msm/topology/network.h"
#include "problem/material.h"

namespace springproof {

/// Stiffness of the anchors of a part together, in units of E A / l, A the area of the patch in the cell of edge l: a
/// support gives way like a thirtieth of a cell.  Stiffer anchors make clamped bodies, which coarse cells leave too
/// stiff, stiffer still.
inline constexpr double anchor_stiffness = 30;

inline constexpr std::size_t anchors_of_part = 4, bonds_of_part = 3;

/// @throws std::invalid_argument if a cell of the body has another material than these many.
void require_materials(const CutBody& body, std::size_t materials);

/// Anchors of a patch, four for its part in each cell, in that order.  With R_a the integral of N_a (x - c) over the
/// part of area A and centroid c, over A, and W the second moments of its area in the plane of their two larger
/// principal axes, over A, the rows
///   m_a = 1/A int N_a dA,    (G_1a, G_2a) = W^(1/2) T^-1 V W^-1 R_a
/// are the mean of u over the part and its two first moments, these times the share T^-1 V: V are the second moments of
/// the parts at the nodes of the cell about their own centroids, T those about the common one.  The share is 1 where
/// one cell alone holds that rotation, as in a sheet one layer of cells thick, and 1/9 within a wide face.  The anchors
///   w_qa = m_a + sqrt(2) (cos(2 pi q/3) G_1a + sin(2 pi q/3) G_2a),    k_q = 30 E A/(3 l),
/// q = 0, 1, 2, have the energy 15 E A/l (|m u|^2 + |G_1 u|^2 + |G_2 u|^2), whatever axes are chosen in the plane.  The
/// last holds the mean across the part by 30 (M - E) A/l n n^T, n the mean normal, M = lambda + 2 G: material at a
/// support is confined, and near nu = 1/2 the support would give way where the body hardly does.  (1e-3 E more, along
/// every axis, hold its node where nothing else does.)  With M for the moments too a body that stands on small feet is
/// 2 % stiffer.
/// Weights sum to 1, and the mean of the corners by them is a point in the plane of the part.
/// @param body a body in cells
/// @param patch name of a patch
/// @param material_of of the cell of a number, in the body
/// @return anchors without a node (-1)
/// @throws std::out_of_range if the body has no such patch
std::vector<Anchor> anchors_of_patch(const CutBody& body, const std::string& patch,
                                     const std::function<IsotropicMaterial(int cell)>& material_of);
/// The same, `materials` of its cells by their number.
std::vector<Anchor> anchors_of_patch(const CutBody& body, const std::string& patch,
                                     const std::vector<IsotropicMaterial>& materials);

/// Bonds of the interfaces of a body, three for each pair of cells that have one: an anchor's rows m and G of both
/// cells, where the parts of the interface that count for the share are those at nodes of either cell.  Their stiffness
/// together is 30 A/l (E_h 1 + (M_h - E_h) n n^T), l the edge of the larger cell, E_h the harmonic mean of the moduli,
/// n the mean normal; M_h, that of lambda + 2 G, replaces E_h across the interface if one of the materials has a
/// Poisson's ratio above 0.45.
/// @param body a body in cells
/// @param materials of its cells, by their number
/// @return bonds
std::vector<InterfaceBond> bonds_of_interfaces(const CutBody& body, const std::vector<IsotropicMaterial>& materials);

}  // namespace springproof
