// An L-shaped bracket in the box [0, size]: a wall plate (x from 0 to a fifth) and a shelf (the lowest fifth), with a
// fillet of a fifth between them, of the depth size_y; tetrahedra of edge `edge`.
// Patches: wall (x = 0), end (of the shelf, x = size_x), top (of the shelf), bottom, fillet, skin (the rest).
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.1, size_y = 0.05, size_z = 0.1  // [m]
];
DefineConstant[edge = size_z / 20];  // [m]

w = size_x / 5;
h = size_z / 5;
Point(1) = {0, 0, 0};
Point(2) = {size_x, 0, 0};
Point(3) = {size_x, 0, h};
Point(4) = {2 * w, 0, h};
Point(5) = {w, 0, 2 * h};
Point(6) = {w, 0, size_z};
Point(7) = {0, 0, size_z};
Point(8) = {2 * w, 0, 2 * h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
If (w == h)
  Circle(4) = {4, 8, 5};
ElseIf (w > h)
  Ellipse(4) = {4, 8, 5, 5};
Else
  Ellipse(4) = {4, 8, 4, 5};
EndIf
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 1};
Curve Loop(1) = {1 : 7};
Plane Surface(1) = {1};
solid[] = Extrude {0, size_y, 0} { Surface{1}; };

// solid[0]: the far side; solid[1]: the volume; from solid[2]: the faces of lines 1 to 7.
Physical Volume("body") = {solid[1]};
Physical Surface("bottom") = {solid[2]};
Physical Surface("end") = {solid[3]};
Physical Surface("top") = {solid[4]};
Physical Surface("fillet") = {solid[5]};
Physical Surface("skin") = {1, solid[0], solid[6], solid[7]};
Physical Surface("wall") = {solid[8]};
Mesh.CharacteristicLengthMin = edge;
Mesh.CharacteristicLengthMax = edge;
