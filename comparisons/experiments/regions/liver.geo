// A rounded slab as large as a lobe of a liver, on a plane face: half of an ellipsoid.
SetFactory("OpenCASCADE");
DefineConstant[size_x = 0.12, size_y = 0.08, size_z = 0.05, edge = 0.01];  // [m]
Sphere(1) = {0, 0, 0, 1, 0, Pi/2, 2 * Pi};
Dilate{ {0, 0, 0}, {size_x / 2, size_y / 2, size_z} } { Volume{1}; }
eps = 1e-6;
Physical Volume("liver") = {1};
bottom[] = Surface In BoundingBox{-size_x, -size_y, -eps, size_x, size_y, eps};
Physical Surface("bottom") = {bottom[]};
// Finer around what is pressed and what lies below it.
Field[1] = Ball;
Field[1].XCenter = 0.005; Field[1].YCenter = 0; Field[1].ZCenter = 0.035;
Field[1].Radius = 0.022; Field[1].Thickness = 0.01;
Field[1].VIn = edge / 1.4; Field[1].VOut = edge;
Background Field = 1;
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthMin = edge / 1.4;
Mesh.CharacteristicLengthMax = edge;
