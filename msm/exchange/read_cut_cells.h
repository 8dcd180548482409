// What a springs file says of cut cells: their sizes, filled parts, anchors and shares in loads.
#pragma once

#include "msm/exchange/json_place.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// `edge_m` of the cells; of several sizes, from version 3 on, a list.
/// @param cells with their nodes in `network`
/// @param version of the file
void read_edges(const JsonPlace& cells, double version, Network& network);

/// `carried` of the document: nodes that are the means of others, which have no mass, and no others without.
/// @throws InputError unless each is in its mean at rest, and follows none that comes later.
void read_carried(const JsonPlace& document, Network& network);

/// `proportions` of the cells: boxes instead of cubes, from version 4 on.
/// @throws InputError unless their product is 1 and the cells are full and of one size.
void read_proportions(const JsonPlace& cells, double version, Network& network);

/// The moments beside the cells' nodes, if there are any.
/// @throws InputError unless they can be those of a part of a cube.
void read_filled(const JsonPlace& cells, Network& network);

/// `regions` of the document, `material` of its cells and `bonds` between them, from version 5 on.
/// @param document with its cells in the network of `file`
/// @throws InputError unless the cells are cut, have the masses of the nodes, and bonds are at rest and hold.
void read_materials(const JsonPlace& document, double version, SpringsFile& file);

/// `anchors` and `loads` of the document and `weight_kg` of its nodes.
/// @throws InputError also if an anchor is not at rest.
void read_supports_and_loads(const JsonPlace& document, double version, SpringsFile& file);

}  // namespace springproof
