// The block [0, size_x] x [0, size_y] x [0, size_z], cut into nx x ny x nz equal boxes.
DefineConstant[
  size_x = 1, size_y = 1, size_z = 1,  // [m]
  nx = 10, ny = 10, nz = 10,
  tetrahedra = 0  // 1: each box cut into tetrahedra
];

Point(1) = {0, 0, 0};
If (tetrahedra)
  edge[] = Extrude {size_x, 0, 0} { Point{1}; Layers{nx}; };
  side[] = Extrude {0, size_y, 0} { Line{edge[1]}; Layers{ny}; };
  body[] = Extrude {0, 0, size_z} { Surface{side[1]}; Layers{nz}; };
Else
  edge[] = Extrude {size_x, 0, 0} { Point{1}; Layers{nx}; };
  side[] = Extrude {0, size_y, 0} { Line{edge[1]}; Layers{ny}; Recombine; };
  body[] = Extrude {0, 0, size_z} { Surface{side[1]}; Layers{nz}; Recombine; };
EndIf

Physical Surface("x_min") = {body[5]};
Physical Surface("x_max") = {body[3]};
Physical Surface("y_min") = {body[2]};
Physical Surface("y_max") = {body[4]};
Physical Surface("z_min") = {side[1]};
Physical Surface("z_max") = {body[0]};
Physical Volume("body") = {body[1]};
