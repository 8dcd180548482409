// A right hand in the box [0, size], palm to -y, fingers along z, wrist cut flat at z = 0; tetrahedra of edge `edge`.
// Patches: wrist, the round ends of thumb index middle ring little, skin (the rest).
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.137, size_y = 0.035, size_z = 0.188  // [m]
];
DefineConstant[edge = size_z / 30];  // [m]
Include "solids.inc";

// Drawn in centimetres.
Box(1) = {-4.1, -1.4, 2, 8.2, 2.8, 8.3};  // palm
edges[] = Abs(Boundary { Surface{Boundary { Volume{1}; }}; });
Fillet {1} { Unique(edges[]) } {1}
l = 0;
v = 2; t = 0; cx = 0; cy = 0; cz = 0; rx = 3.1; ry = 1.75; rz = 6; Call Oval;  // wrist
cy = 0;
t = -0.75; cx = -3; cz = 3.5; h = 8.2; ra = 1.25; rb = 0.95; // thumb
Call Limb;
parts[] = {v};
t = -0.11; cx = -3; cz = 8; h = 10; ra = 0.88; rb = 0.72; // index
Call Limb;
parts[] += {v};
t = -0.02; cx = -1; cz = 8; h = 10.8; ra = 0.88; rb = 0.75; // middle
Call Limb;
parts[] += {v};
t = 0.07; cx = 1.05; cz = 8; h = 10.2; ra = 0.88; rb = 0.7; // ring
Call Limb;
parts[] += {v};
t = 0.18; cx = 2.9; cz = 7.5; h = 8.5; ra = 0.8; rb = 0.62; // little
Call Limb;
parts[] += {v};
all[] = BooleanUnion { Volume{1}; Delete; } { Volume{2, parts[]}; Delete; };
arm = newv;
Box(arm) = {-20, -20, -10, 40, 40, 10};
body[] = BooleanDifference { Volume{all[]}; Delete; } { Volume{arm}; Delete; };

low[] = {-8.892, -1.75, 0};
high[] = {4.931, 1.75, 18.798};
Include "fit.inc";
a[] = {-20, -20, -0.1}; b[] = {20, 20, 0.1}; Call Faces;
wrist[] = faces[];
skin[] -= {wrist[]};
// The round ends: middle and radius as the limbs above have them.
x[] = {-7.94, -4.02, -1.2, 1.71, 4.31};
z[] = {8.8, 17.22, 18.05, 17.48, 15.25};
r[] = {0.95, 0.72, 0.75, 0.7, 0.62};
For i In {0 : 4}
  a[] = {x[i] - 2.2 * r[i], -2.2 * r[i], z[i] - 2.2 * r[i]};
  b[] = {x[i] + 2.2 * r[i], 2.2 * r[i], z[i] + 2.2 * r[i]};
  Call Faces;
  ends~{i}[] = faces[];
  skin[] -= {faces[]};
EndFor
Physical Surface("wrist") = wrist[];
Physical Surface("thumb") = ends~{0}[];
Physical Surface("index") = ends~{1}[];
Physical Surface("middle") = ends~{2}[];
Physical Surface("ring") = ends~{3}[];
Physical Surface("little") = ends~{4}[];
Physical Surface("skin") = skin[];
