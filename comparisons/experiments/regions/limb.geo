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
// Finer around the bone, whose section is what the load meets.
Field[1] = Cylinder;
Field[1].XCenter = 0; Field[1].YCenter = 0; Field[1].ZCenter = 0;
Field[1].XAxis = 0; Field[1].YAxis = 0; Field[1].ZAxis = 1.1 * size_z;
Field[1].Radius = 0.4 * size_x;
Field[1].VIn = edge / 2; Field[1].VOut = edge;
Background Field = 1;
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthMin = edge / 2;
Mesh.CharacteristicLengthMax = edge;
