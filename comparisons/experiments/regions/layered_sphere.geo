// An eighth of a ball of radius size_x with a core of half that radius.
SetFactory("OpenCASCADE");
DefineConstant[size_x = 0.02, size_y = 0.02, size_z = 0.02, edge = 0.005];  // [m]
Sphere(1) = {0, 0, 0, size_x, 0, Pi/2, Pi/2};
Sphere(2) = {0, 0, 0, size_x / 2, 0, Pi/2, Pi/2};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
eps = 1e-6;
core[] = Volume In BoundingBox{-eps, -eps, -eps, size_x / 2 + eps, size_x / 2 + eps, size_x / 2 + eps};
shell[] = Volume{:};
shell[] -= {core[]};
x_min[] = Surface In BoundingBox{-eps, -eps, -eps, eps, size_x + eps, size_x + eps};
y_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, eps, size_x + eps};
z_min[] = Surface In BoundingBox{-eps, -eps, -eps, size_x + eps, size_x + eps, eps};
outside[] = Abs(CombinedBoundary{ Volume{:}; });
outside[] -= {x_min[], y_min[], z_min[]};
Physical Volume("core") = {core[]};
Physical Volume("shell") = {shell[]};
Physical Surface("x_min") = {x_min[]};
Physical Surface("y_min") = {y_min[]};
Physical Surface("z_min") = {z_min[]};
Physical Surface("outside") = {outside[]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
