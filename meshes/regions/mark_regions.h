// Regions of a body that are of other materials: which cells are theirs.
#pragma once

#include <string>
#include <vector>

#include "meshes/mesh.h"
#include "meshes/surface/surface.h"
#include "problem/region.h"

namespace springproof {

/// Sets the materials of a mesh: to the cells of physical volumes, which it has, come those of boxes, balls,
/// half-spaces and closed surfaces.  Tetrahedra are cut along their borders, curved ones by chords between its edges;
/// of hexahedra a region has whole ones.  Where regions overlap the later one is.
/// @param coarseness edges of this mesh over those of the finest one of the body
/// @return each region's share of the volume, and what of it lies outside of the body or in later regions
/// @throws InputError at a region that holds no cell, one whose border runs through hexahedra, and a surface that is
/// not closed
std::vector<std::string> mark_regions(const std::vector<MaterialRegion>& regions, double coarseness, Mesh& mesh);

/// Marks what a closed surface encloses as material `number`, by tetrahedra cut along it.
void mark_enclosed(const Surface& surface, std::uint8_t number, double coarseness, Mesh& mesh);

/// Whether the borders of boxes, balls, half-spaces and surfaces run along faces of the mesh's hexahedra, so that every
/// mesh with this property has the same regions; true of tetrahedra, which are cut.
bool end_at_faces_of(const Mesh& mesh, const std::vector<MaterialRegion>& regions);

}  // namespace springproof
