// Included last by the bodies that are made of blocks: structured hexahedra, or each of them cut into tetrahedra.
Transfinite Surface "*";
If (tetrahedra == 0)
  Recombine Surface "*";
EndIf
Transfinite Volume "*";
