// What a springs file says of cut cells: filled parts, anchors and shares in loads.
#pragma once

#include "msm/exchange/json_place.h"
#include "msm/exchange/springs_file.h"

namespace springproof {

/// The moments beside the cells' nodes, if there are any.
/// @throws InputError unless they can be those of a part of a cube.
void read_filled(const JsonPlace& cells, Network& network);

/// `anchors` and `loads` of the document and `weight_kg` of its nodes.
/// @throws InputError also if an anchor is not at rest.
void read_supports_and_loads(const JsonPlace& document, SpringsFile& file);

}  // namespace springproof
