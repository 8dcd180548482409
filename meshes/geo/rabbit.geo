// A sitting rabbit in the box [0, size], facing x, z up; tetrahedra of edge `edge`.
// Patches: feet (soles), ears, head, skin (the rest).
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.2, size_y = 0.12, size_z = 0.25  // [m]
];
DefineConstant[edge = size_z / 20];  // [m]
Include "solids.inc";

// Drawn 20 long, 12 wide and 25 high.
l = 0;
v = 1; t = 0.35; cx = 7.8; cy = 6; cz = 7; rx = 6.6; ry = 5; rz = 6.3; Call Oval;       // body
v = 2; t = 0.5; cx = 11.6; cy = 6; cz = 9.6; rx = 4; ry = 3.9; rz = 6.4; Call Oval;     // chest
v = 3; t = 0.25; cx = 15; cy = 6; cz = 16; rx = 4.1; ry = 3.3; rz = 3.4; Call Oval;     // head
v = 4; t = 0.25; cx = 17.7; cy = 6; cz = 14.9; rx = 2.3; ry = 2.1; rz = 1.9; Call Oval; // snout
v = 5; t = 0; cx = 1.7; cy = 6; cz = 3.9; rx = 1.7; ry = 1.7; rz = 1.7; Call Oval;      // tail
For side In {-1 : 1 : 2}
  v = 10 + side; t = 0; cx = 7; cy = 6 + 3.4 * side; cz = 4.6; rx = 4.4; ry = 2.6; rz = 4.3; Call Oval;       // haunch
  v = 20 + side; t = 0; cx = 10; cy = 6 + 3.9 * side; cz = 0.9; rx = 4.6; ry = 1.5; rz = 1.6; Call Oval;      // hind foot
  v = 30 + side; t = 0.12; cx = 14.4; cy = 6 + 1.9 * side; cz = 4.2; rx = 1.5; ry = 1.4; rz = 5.2; Call Oval; // foreleg
  v = 40 + side; t = 0; cx = 15.7; cy = 6 + 1.9 * side; cz = 0.6; rx = 2.2; ry = 1.3; rz = 1.3; Call Oval;    // forefoot
  v = 50 + side; t = -0.28; l = -0.16 * side; cx = 12.4; cy = 6 + 1.9 * side; cz = 20.7; rx = 0.95; ry = 1.4; rz = 4.5;
  Call Oval;                                                                                                    // ear
  l = 0;
EndFor
all[] = BooleanUnion { Volume{1}; Delete; } { Volume{2 : 5, 9, 11, 19, 21, 29, 31, 39, 41, 49, 51}; Delete; };
Box(100) = {-10, -10, -10, 50, 50, 10};  // the ground
body[] = BooleanDifference { Volume{all[]}; Delete; } { Volume{100}; Delete; };

low[] = {0, 0, 0};
high[] = {19.977, 12, 24.983};
Include "fit.inc";
a[] = {-20, -20, -0.1}; b[] = {40, 40, 0.1}; Call Faces;
feet[] = faces[];
a[] = {5, -5, 15.5}; b[] = {25, 17, 30}; Call Faces;
ears[] = faces[];
a[] = {5, -5, 11.2}; b[] = {25, 17, 30}; Call Faces;
head[] = faces[]; head[] -= ears[];
skin[] -= {feet[], ears[], head[]};
Physical Surface("feet") = feet[];
Physical Surface("ears") = ears[];
Physical Surface("head") = head[];
Physical Surface("skin") = skin[];
