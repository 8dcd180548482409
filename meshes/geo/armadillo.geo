// An armadillo-like figure in the box [0, size], standing, facing x, z up; tetrahedra of edge `edge`.
// Patches: feet (soles), left_arm and right_arm (the hands; left is +y), head, tail, skin (the rest).
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.21, size_y = 0.22, size_z = 0.25  // [m]
];
DefineConstant[edge = size_z / 20];  // [m]
Include "solids.inc";

l = 0;
v = 1; t = 0; cx = 0; cy = 0; cz = 7; rx = 2.4; ry = 2.6; rz = 3.6; Call Oval;             // trunk
v = 2; t = 0.15; cx = -1.1; cy = 0; cz = 7.4; rx = 2.6; ry = 3.1; rz = 3.9; Call Oval;     // shell
v = 3; t = 0.2; cx = 1; cy = 0; cz = 12.3; rx = 1.9; ry = 1.5; rz = 1.6; Call Oval;        // head
t = 0.2; cx = 0; cy = 0; cz = 9.3; h = 3.4; ra = 1.45; rb = 1; // neck
Call Limb;
parts[] = {v};
t = 1.75; cx = 1.5; cy = 0; cz = 12.2; h = 4.4; ra = 1.1; rb = 0.45; // snout
Call Limb;
parts[] += {v};
t = -1.92; cx = -2; cy = 0; cz = 4.6; h = 5.5; ra = 1.1; rb = 0.25; // tail
Call Limb;
parts[] += {v};
For side In {-1 : 1 : 2}
  cx = 0.4; cy = side; cz = 14; rx = 0.4; ry = 0.75; rz = 1.3; t = 0; l = -0.35 * side;
  v = newv; // ear
  Call Oval;
  parts[] += {v};
  cx = 0.2; cy = 1.6 * side; cz = 8.8; h = 4.4; ra = 0.95; rb = 0.8; t = 0.5; l = -1.7 * side;
  // upper arm
  Call Limb;
  parts[] += {v};
  cx = 1.9; cy = 4.7 * side; cz = 8.4; h = 3.9; ra = 0.6; rb = 0.5; t = 0.5; l = -0.35 * side;
  // forearm
  Call Limb;
  parts[] += {v};
  cx = 3.6; cy = 5.8 * side; cz = 11.4; rx = 0.95; ry = 0.75; rz = 1.2; t = 0.5; l = 0;
  v = newv; // hand
  Call Oval;
  parts[] += {v};
  cx = 0; cy = 1.4 * side; cz = 5; h = 5; ra = 1.5; rb = 0.9; t = Pi - 0.15; l = 0.2 * side;
  // leg
  Call Limb;
  parts[] += {v};
  cx = 1.3; cy = 2.3 * side; cz = 0.5; rx = 2; ry = 1.15; rz = 1.1; t = 0; l = 0;
  v = newv; // foot
  Call Oval;
  parts[] += {v};
EndFor
all[] = BooleanUnion { Volume{1}; Delete; } { Volume{2, 3, parts[]}; Delete; };
ground = newv;
Box(ground) = {-20, -20, -10, 40, 40, 10};
body[] = BooleanDifference { Volume{all[]}; Delete; } { Volume{ground}; Delete; };

low[] = {-7.183, -6.55, 0};
high[] = {5.837, 6.55, 15.246};
Include "fit.inc";
a[] = {-20, -20, -0.1}; b[] = {20, 20, 0.1}; Call Faces;
feet[] = faces[];
a[] = {0, 4.4, 9}; b[] = {9, 9, 14}; Call Faces;
left[] = faces[];
a[] = {0, -9, 9}; b[] = {9, -4.4, 14}; Call Faces;
right[] = faces[];
a[] = {-3, -3, 10.3}; b[] = {9, 3, 16}; Call Faces;
head[] = faces[];
a[] = {-9, -3, 0.2}; b[] = {-1.3, 3, 6.4}; Call Faces;
tail[] = faces[];
skin[] -= {feet[], left[], right[], head[], tail[]};
Physical Surface("feet") = feet[];
Physical Surface("left_arm") = left[];
Physical Surface("right_arm") = right[];
Physical Surface("head") = head[];
Physical Surface("tail") = tail[];
Physical Surface("skin") = skin[];
