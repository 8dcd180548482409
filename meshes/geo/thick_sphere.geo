// An octant of a thick-walled sphere, outer radius size_x, inner half of it: three blocks that meet on the diagonal.
// nx = ny cells along each side of a block, nz through the wall.
DefineConstant[
  size_x = 2, size_y = 2, size_z = 2,  // [m]
  nx = 4, ny = 4, nz = 8,
  tetrahedra = 0
];

Point(1) = {0, 0, 0};
For s In {0 : 1}
  r = s ? size_x : size_x / 2;
  n = 10 + 10 * s;
  h = r / Sqrt(2);
  d = r / Sqrt(3);
  Point(n + 1) = {r, 0, 0};
  Point(n + 2) = {0, r, 0};
  Point(n + 3) = {0, 0, r};
  Point(n + 4) = {h, h, 0};
  Point(n + 5) = {0, h, h};
  Point(n + 6) = {h, 0, h};
  Point(n + 7) = {d, d, d};
  // Arcs: from each axis to the two halves beside it, from the halves to the middle.  All run away from the axes, so
  // that tetrahedra fit the triangles of the walls between the blocks.
  Circle(n + 1) = {n + 1, 1, n + 4};
  Circle(n + 2) = {n + 2, 1, n + 4};
  Circle(n + 3) = {n + 2, 1, n + 5};
  Circle(n + 4) = {n + 3, 1, n + 5};
  Circle(n + 5) = {n + 3, 1, n + 6};
  Circle(n + 6) = {n + 1, 1, n + 6};
  Circle(n + 7) = {n + 4, 1, n + 7};
  Circle(n + 8) = {n + 5, 1, n + 7};
  Circle(n + 9) = {n + 6, 1, n + 7};
  Curve Loop(n + 1) = {n + 1, n + 7, -(n + 9), -(n + 6)};
  Curve Loop(n + 2) = {n + 3, n + 8, -(n + 7), -(n + 2)};
  Curve Loop(n + 3) = {n + 5, n + 9, -(n + 8), -(n + 4)};
  Surface(n + 1) = {n + 1} In Sphere {1};
  Surface(n + 2) = {n + 2} In Sphere {1};
  Surface(n + 3) = {n + 3} In Sphere {1};
EndFor
For i In {1 : 7}
  Line(30 + i) = {10 + i, 20 + i};
EndFor

// Walls over the arcs, numbered as these.
start[] = {1, 2, 2, 3, 3, 1, 4, 5, 6};
end[] = {4, 4, 5, 5, 6, 6, 7, 7, 7};
For i In {1 : 9}
  Curve Loop(40 + i) = {10 + i, 30 + end[i - 1], -(20 + i), -(30 + start[i - 1])};
  Surface(40 + i) = {40 + i};
EndFor
Surface Loop(1) = {11, 21, 41, 47, 49, 46};
Surface Loop(2) = {12, 22, 43, 48, 47, 42};
Surface Loop(3) = {13, 23, 45, 49, 48, 44};
Volume(1) = {1};
Volume(2) = {2};
Volume(3) = {3};

Transfinite Curve{11 : 19, 21 : 29} = nx + 1;
Transfinite Curve{31 : 37} = nz + 1;

Physical Surface("inner") = {11, 12, 13};
Physical Surface("outer") = {21, 22, 23};
Physical Surface("z_min") = {41, 42};
Physical Surface("x_min") = {43, 44};
Physical Surface("y_min") = {45, 46};

Include "structured.inc";
