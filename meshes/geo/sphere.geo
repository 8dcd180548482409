// A sphere (an ellipsoid) in the box [0, size]; tetrahedra of edge `edge`.  Patch: surface.
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 1, size_y = 1, size_z = 1  // [m], diameters
];
DefineConstant[edge = (size_x + size_y + size_z) / 60];  // [m]

Sphere(1) = {0, 0, 0, 0.5};
Dilate {{0, 0, 0}, {size_x, size_y, size_z}} { Volume{1}; }
Translate {size_x / 2, size_y / 2, size_z / 2} { Volume{1}; }

Physical Surface("surface") = Boundary { Volume{1}; };
Physical Volume("body") = {1};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
