// A beam along x, [0, size_x], with a section of size_y x size_z that turns by 90 degrees about x from the root, where
// its width size_y lies along y, to the tip, where it lies along z.  Patches: root, tip, and the four sides.
DefineConstant[
  size_x = 12, size_y = 1.1, size_z = 0.32,
  nx = 12, ny = 2, nz = 2,
  tetrahedra = 0
];

points = 48;  // of the spline along each edge
For c In {1 : 4}
  y = (c == 1 || c == 4 ? -0.5 : 0.5) * size_y;
  z = (c <= 2 ? -0.5 : 0.5) * size_z;
  For i In {0 : points}
    t = i / points * Pi / 2;
    Point(100 * c + i) = {size_x * i / points, y * Cos(t) - z * Sin(t), y * Sin(t) + z * Cos(t)};
  EndFor
  Spline(c) = {100 * c : 100 * c + points};
EndFor
For c In {1 : 4}
  next = 1 + c % 4;
  Line(10 + c) = {100 * c, 100 * next};
  Line(20 + c) = {100 * c + points, 100 * next + points};
EndFor
// Opposite sides run the same way: so tetrahedra fit their triangles.
Curve Loop(1) = {1, 21, -2, -11};
Curve Loop(2) = {2, 22, -3, -12};
Curve Loop(3) = {4, -23, -3, 13};
Curve Loop(4) = {1, -24, -4, 14};
For c In {1 : 4}
  Surface(c) = {c};
EndFor
Curve Loop(5) = {11 : 14};
Plane Surface(5) = {5};
Curve Loop(6) = {21 : 24};
Plane Surface(6) = {6};
Surface Loop(1) = {1 : 6};
Volume(1) = {1};

Transfinite Curve{1 : 4} = nx + 1;
Transfinite Curve{11, 13, 21, 23} = ny + 1;
Transfinite Curve{12, 14, 22, 24} = nz + 1;

Physical Surface("root") = {5};
Physical Surface("tip") = {6};
Physical Surface("sides") = {1 : 4};

Include "structured.inc";
