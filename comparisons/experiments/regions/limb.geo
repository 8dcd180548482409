// A quarter of a limb: a bone of radius 0.3 size_x in flesh of radius size_x, along z.
SetFactory("OpenCASCADE");
DefineConstant[size_x = 0.04, size_y = 0.04, size_z = 0.06, edge = 0.01];  // [m]
Cylinder(1) = {0, 0, 0, 0, 0, size_z, size_x, Pi/2};
Cylinder(2) = {0, 0, 0, 0, 0, size_z, 0.3 * size_x, Pi/2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
eps = 1e-6;
bone[] = Volume In BoundingBox{-eps, -eps, -eps, 0.3 * size_x + eps, 0.3 * size_x + eps, size_z + eps};
x_min[] = Surface In BoundingBox{-eps, -eps, -eps, eps, size_x + eps, size_z + eps};
y_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, eps, size_z + eps};
z_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, size_x + eps, eps};
z_max[] = Surface In BoundingBox{-eps, -eps, size_z - eps, size_x + eps, size_x + eps, size_z + eps};
Physical Volume("bone") = {bone[]};
Physical Volume("limb") = {Volume{:}};
Physical Surface("x_min") = {x_min[]};
Physical Surface("y_min") = {y_min[]};
Physical Surface("z_min") = {z_min[]};
Physical Surface("z_max") = {z_max[]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
