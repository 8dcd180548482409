// The block [0, size_x] x [0, size_y] x [0, size_z] with flat faces, made of 3 x 3 x 3 blocks whose corners are shifted:
// no two cells are alike, and halved grids nest.  nx, ny, nz: multiples of 3.
DefineConstant[
  size_x = 1, size_y = 1, size_z = 1,  // [m]
  nx = 6, ny = 6, nz = 6,
  tetrahedra = 0
];

// Corner (i, j, k), i fastest.  A shift of a third of a block along x, at most, and none off the faces.
For k In {0 : 3}
  For j In {0 : 3}
    For i In {0 : 3}
      n = 1 + i + 4 * j + 16 * k;
      shift_x = (i == 0 || i == 3) ? 0 : 0.08 * Cos(2 * i + 1.7 * j + 2.9 * k);
      shift_y = (j == 0 || j == 3) ? 0 : 0.08 * Cos(1.3 * i + 2.2 * j + 0.8 * k + 1);
      shift_z = (k == 0 || k == 3) ? 0 : 0.08 * Cos(2.4 * i + 0.9 * j + 1.9 * k + 2);
      Point(n) = {size_x * (i / 3 + shift_x), size_y * (j / 3 + shift_y), size_z * (k / 3 + shift_z)};
    EndFor
  EndFor
EndFor

// Edge from corner n along axis 1, 2, 3: number 100 * axis + n.
For n In {1 : 64}
  i = (n - 1) % 4;
  j = Floor((n - 1) / 4) % 4;
  k = Floor((n - 1) / 16);
  If (i < 3)
    Line(100 + n) = {n, n + 1};
    Transfinite Curve{100 + n} = nx / 3 + 1;
  EndIf
  If (j < 3)
    Line(200 + n) = {n, n + 4};
    Transfinite Curve{200 + n} = ny / 3 + 1;
  EndIf
  If (k < 3)
    Line(300 + n) = {n, n + 16};
    Transfinite Curve{300 + n} = nz / 3 + 1;
  EndIf
EndFor

// Face from corner n across axis 1, 2, 3: number 100 * axis + n.
For n In {1 : 64}
  i = (n - 1) % 4;
  j = Floor((n - 1) / 4) % 4;
  k = Floor((n - 1) / 16);
  If (j < 3 && k < 3)
    Curve Loop(100 + n) = {200 + n, 300 + n + 4, -(200 + n + 16), -(300 + n)};
    Surface(100 + n) = {100 + n};
  EndIf
  If (i < 3 && k < 3)
    Curve Loop(200 + n) = {100 + n, 300 + n + 1, -(100 + n + 16), -(300 + n)};
    Surface(200 + n) = {200 + n};
  EndIf
  If (i < 3 && j < 3)
    Curve Loop(300 + n) = {100 + n, 200 + n + 1, -(100 + n + 4), -(200 + n)};
    Surface(300 + n) = {300 + n};
  EndIf
EndFor

x_min[] = {}; x_max[] = {}; y_min[] = {}; y_max[] = {}; z_min[] = {}; z_max[] = {};
For k In {0 : 2}
  For j In {0 : 2}
    x_min[] += 100 + 1 + 4 * j + 16 * k;
    x_max[] += 100 + 4 + 4 * j + 16 * k;
    y_min[] += 200 + 1 + j + 16 * k;
    y_max[] += 200 + 13 + j + 16 * k;
    z_min[] += 300 + 1 + j + 4 * k;
    z_max[] += 300 + 49 + j + 4 * k;
    For i In {0 : 2}
      n = 1 + i + 4 * j + 16 * k;
      Surface Loop(n) = {100 + n, 100 + n + 1, 200 + n, 200 + n + 4, 300 + n, 300 + n + 16};
      Volume(n) = {n};
    EndFor
  EndFor
EndFor

Physical Surface("x_min") = {x_min[]};
Physical Surface("x_max") = {x_max[]};
Physical Surface("y_min") = {y_min[]};
Physical Surface("y_max") = {y_max[]};
Physical Surface("z_min") = {z_min[]};
Physical Surface("z_max") = {z_max[]};

Include "structured.inc";
