// A sphere (an ellipsoid) in the box [0, size]; tetrahedra, about two cells wide: a body for voxels.
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 1, size_y = 1, size_z = 1,  // [m], diameters
  nx = 20, ny = 20, nz = 20,
  tetrahedra = 1
];

Sphere(1) = {0, 0, 0, 0.5};
Dilate {{0, 0, 0}, {size_x, size_y, size_z}} { Volume{1}; }
Translate {size_x / 2, size_y / 2, size_z / 2} { Volume{1}; }

Physical Surface("surface") = Boundary { Volume{1}; };
Physical Volume("body") = {1};

width = 2 * (size_x / nx + size_y / ny + size_z / nz) / 3;
Mesh.CharacteristicLengthMin = width;
Mesh.CharacteristicLengthMax = width;
