// Cook's tapered panel: corners (0, 0), (48, 44), (48, 60), (0, 44) of a box of 48 x 60, thickness size_z.
// nx cells from the clamped side x_min to the loaded side x_max, ny across, nz through the thickness.
DefineConstant[
  size_x = 48, size_y = 60, size_z = 1,
  nx = 8, ny = 8, nz = 1,
  tetrahedra = 0
];

For k In {0 : 1}
  n = 10 * k;
  Point(n + 1) = {0, 0, k * size_z};
  Point(n + 2) = {size_x, size_y * 44 / 60, k * size_z};
  Point(n + 3) = {size_x, size_y, k * size_z};
  Point(n + 4) = {0, size_y * 44 / 60, k * size_z};
  For i In {1 : 4}
    Line(n + i) = {n + i, n + 1 + i % 4};
  EndFor
  Curve Loop(n + 1) = {n + 1 : n + 4};
  Plane Surface(n + 1) = {n + 1};
EndFor
For i In {1 : 4}
  Line(20 + i) = {i, 10 + i};
EndFor
// Opposite sides start at opposite corners: so tetrahedra fit their triangles.
Curve Loop(21) = {1, 22, -11, -21};
Curve Loop(22) = {2, 23, -12, -22};
Curve Loop(23) = {24, -13, -23, 3};
Curve Loop(24) = {21, -14, -24, 4};
For i In {21 : 24}
  Surface(i) = {i};
EndFor
Surface Loop(1) = {1, 11, 21, 22, 23, 24};
Volume(1) = {1};

Transfinite Curve{1, 3, 11, 13} = nx + 1;
Transfinite Curve{2, 4, 12, 14} = ny + 1;
Transfinite Curve{21 : 24} = nz + 1;

Physical Surface("z_min") = {1};
Physical Surface("z_max") = {11};
Physical Surface("y_min") = {21};
Physical Surface("x_max") = {22};
Physical Surface("y_max") = {23};
Physical Surface("x_min") = {24};

Include "structured.inc";
