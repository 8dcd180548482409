// A quarter of a plate with a hole of radius size_y / 5 about the origin, in the box [0, size].
SetFactory("OpenCASCADE");
DefineConstant[size_x = 0.1, size_y = 0.05, size_z = 0.004, edge = 0.002];  // [m]
Box(1) = {0, 0, 0, size_x, size_y, size_z};
Cylinder(2) = {0, 0, -size_z, 0, 0, 3 * size_z, size_y / 5};
body[] = BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; };
eps = 1e-3 * size_y;
x_min[] = Surface In BoundingBox{-eps, -eps, -eps, eps, size_y + eps, size_z + eps};
x_max[] = Surface In BoundingBox{size_x - eps, -eps, -eps, size_x + eps, size_y + eps, size_z + eps};
y_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, eps, size_z + eps};
z_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, size_y + eps, eps};
z_max[] = Surface In BoundingBox{-eps, -eps, size_z - eps, size_x + eps, size_y + eps, size_z + eps};
Physical Volume("body") = {body[]};
Physical Surface("x_min") = {x_min[]};
Physical Surface("x_max") = {x_max[]};
Physical Surface("y_min") = {y_min[]};
Physical Surface("z_min") = {z_min[]};
Physical Surface("z_max") = {z_max[]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
