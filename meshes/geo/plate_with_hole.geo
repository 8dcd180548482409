// A plate [0, size] with a hole through its middle along z, of diameter min(size_x, size_y) / 4; tetrahedra of edge `edge`.
// Patches: x_min x_max y_min y_max z_min z_max hole.
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.2, size_y = 0.1, size_z = 0.01  // [m]
];
DefineConstant[edge = size_z / 2];  // [m]

Box(1) = {0, 0, 0, size_x, size_y, size_z};
radius = (size_x < size_y ? size_x : size_y) / 8;
Cylinder(2) = {size_x / 2, size_y / 2, -size_z, 0, 0, 3 * size_z, radius};
body[] = BooleanDifference { Volume{1}; Delete; } { Volume{2}; Delete; };

e = 1e-3 * radius;
all[] = Boundary { Volume{body[]}; };
x_min[] = Surface In BoundingBox {-e, -e, -e, e, size_y + e, size_z + e};
x_max[] = Surface In BoundingBox {size_x - e, -e, -e, size_x + e, size_y + e, size_z + e};
y_min[] = Surface In BoundingBox {-e, -e, -e, size_x + e, e, size_z + e};
y_max[] = Surface In BoundingBox {-e, size_y - e, -e, size_x + e, size_y + e, size_z + e};
z_min[] = Surface In BoundingBox {-e, -e, -e, size_x + e, size_y + e, e};
z_max[] = Surface In BoundingBox {-e, -e, size_z - e, size_x + e, size_y + e, size_z + e};
all[] -= {x_min[], x_max[], y_min[], y_max[], z_min[], z_max[]};
Physical Volume("body") = {body[]};
Physical Surface("x_min") = x_min[];
Physical Surface("x_max") = x_max[];
Physical Surface("y_min") = y_min[];
Physical Surface("y_max") = y_max[];
Physical Surface("z_min") = z_min[];
Physical Surface("z_max") = z_max[];
Physical Surface("hole") = all[];
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
