// An octant of a ball of radius size_x with a hollow of half that radius.
SetFactory("OpenCASCADE");
DefineConstant[size_x = 2, size_y = 2, size_z = 2, edge = 0.2];  // [m]
Sphere(1) = {0, 0, 0, size_x, 0, Pi/2, Pi/2};
Sphere(2) = {0, 0, 0, size_x / 2, 0, Pi/2, Pi/2};
body[] = BooleanDifference{ Volume{1}; Delete; }{ Volume{2}; Delete; };
eps = 1e-4 * size_x;
x_min[] = Surface In BoundingBox{-eps, -eps, -eps, eps, size_x + eps, size_x + eps};
y_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, eps, size_x + eps};
z_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, size_x + eps, eps};
inner[] = Surface In BoundingBox{-eps, -eps, -eps, size_x / 2 + eps, size_x / 2 + eps, size_x / 2 + eps};
Physical Volume("body") = {body[]};
Physical Surface("x_min") = {x_min[]};
Physical Surface("y_min") = {y_min[]};
Physical Surface("z_min") = {z_min[]};
Physical Surface("inner") = {inner[]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
