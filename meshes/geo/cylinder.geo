// An elliptic cylinder in the box [0, size], axis z; tetrahedra of edge `edge`.  Patches: bottom (z = 0), top, side.
SetFactory("OpenCASCADE");
DefineConstant[
  size_x = 0.1, size_y = 0.1, size_z = 0.2  // [m]
];
DefineConstant[edge = size_x / 10];  // [m]

Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5};
body[] = {1};
low[] = {-0.5, -0.5, 0};
high[] = {0.5, 0.5, 1};
Include "fit.inc";
a[] = {-9, -9, -0.01}; b[] = {9, 9, 0.01}; Call Faces;
bottom[] = faces[];
a[] = {-9, -9, 0.99}; b[] = {9, 9, 1.01}; Call Faces;
top[] = faces[];
skin[] -= {bottom[], top[]};
Physical Surface("bottom") = bottom[];
Physical Surface("top") = top[];
Physical Surface("side") = skin[];
