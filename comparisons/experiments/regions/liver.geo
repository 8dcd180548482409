// A rounded slab as large as a lobe of a liver, on a plane face: half of an ellipsoid.
SetFactory("OpenCASCADE");
DefineConstant[size_x = 0.12, size_y = 0.08, size_z = 0.05, edge = 0.01];  // [m]
Sphere(1) = {0, 0, 0, 1, 0, Pi/2, 2 * Pi};
Dilate{ {0, 0, 0}, {size_x / 2, size_y / 2, size_z} } { Volume{1}; }
eps = 1e-6;
Physical Volume("liver") = {1};
bottom[] = Surface In BoundingBox{-size_x, -size_y, -eps, size_x, size_y, eps};
Physical Surface("bottom") = {bottom[]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
