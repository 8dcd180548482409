// A bar in the box [0, size]: tetrahedra of edge `edge`, in no order.  Patches: x_min x_max y_min y_max z_min z_max.
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.4, size_y = 0.1, size_z = 0.1  // [m]
];
DefineConstant[edge = size_z / 5];  // [m]
Box(1) = {0, 0, 0, size_x, size_y, size_z};
Physical Volume("body") = {1};
Physical Surface("x_min") = {1};
Physical Surface("x_max") = {2};
Physical Surface("y_min") = {3};
Physical Surface("y_max") = {4};
Physical Surface("z_min") = {5};
Physical Surface("z_max") = {6};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
