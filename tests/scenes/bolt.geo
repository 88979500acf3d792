// A bolt in a sleeve under a stiff head: half of a plane or axisymmetric section, or in 3D a strip of it. Shank and sleeve
// are apart from each other. Lengths in mm.
DefineConstant[
  shank = {1, Name "half width of the shank"}, play = {0.25, Name "between shank and sleeve"},
  sleeve = {1.5, Name "width of the sleeve"}, length = {4, Name "length of the shank"}, head = {1, Name "height of the head"},
  depth = {0, Name "depth in 3D; 0: plane"}, n = {2, Name "elements across the shank"},
  apart = {0, Name "1: the sleeve is a body of its own, in contact with the head"}
];
x[] = {0, shank, shank + play, shank + play + sleeve};
For i In {0 : 3}
  Point(1 + i)  = {x[i], 0, 0};
  Point(11 + i) = {x[i], length, 0};
  Point(21 + i) = {x[i], length + head, 0};
  Line(1 + i)   = {1 + i, 11 + i};
  Line(11 + i)  = {11 + i, 21 + i};
  Transfinite Curve{1 + i} = 4 * n + 1;
  Transfinite Curve{11 + i} = n + 1;
EndFor
For i In {0 : 2}
  If(i != 1)
    Line(31 + i) = {1 + i, 2 + i};
  EndIf
  Line(41 + i) = {11 + i, 12 + i};
  Line(51 + i) = {21 + i, 22 + i};
  Curve Loop(61 + i) = {41 + i, 12 + i, -(51 + i), -(11 + i)};
  Plane Surface(61 + i) = {61 + i};
EndFor
Transfinite Curve{31, 41, 51, 33, 43, 53} = n + 1;
Transfinite Curve{42, 52} = 2;
Curve Loop(1) = {31, 2, -41, -1};
Plane Surface(1) = {1};
below = 43; sides[] = {3, 4};
If(apart)
  gap = -1e-6 * length; // without it gmsh would make one of crown and seat
  Point(103) = {x[2], length - gap, 0};
  Point(104) = {x[3], length - gap, 0};
  Line(103) = {3, 103};
  Line(104) = {4, 104};
  Line(143) = {103, 104};
  Transfinite Curve{103, 104} = 4 * n + 1;
  Transfinite Curve{143} = n + 1;
  below = 143; sides[] = {103, 104};
EndIf
Curve Loop(2) = {33, sides[1], -below, -sides[0]};
Plane Surface(2) = {2};
Transfinite Surface{1, 2, 61, 62, 63};
Recombine Surface{1, 2, 61, 62, 63};
If(depth == 0)
  Physical Surface("shank") = {1};
  Physical Surface("sleeve") = {2};
  Physical Surface("head") = {61, 62, 63};
  Physical Curve("ground") = {31, 33};
  Physical Curve("middle") = {1, 11};
  Physical Curve("top") = {51, 52, 53};
  Physical Curve("seat") = {43};
  Physical Curve("crown") = {below};
Else
  a[] = Extrude{0, 0, depth}{ Surface{1}; Layers{1}; Recombine; };
  h0[] = Extrude{0, 0, depth}{ Surface{61}; Layers{1}; Recombine; };
  h1[] = Extrude{0, 0, depth}{ Surface{62}; Layers{1}; Recombine; };
  h2[] = Extrude{0, 0, depth}{ Surface{63}; Layers{1}; Recombine; };
  b[] = Extrude{0, 0, depth}{ Surface{2}; Layers{1}; Recombine; };
  Physical Volume("shank") = {a[1]};
  Physical Volume("sleeve") = {b[1]};
  Physical Volume("head") = {h0[1], h1[1], h2[1]};
  Physical Surface("ground") = {a[2], b[2]};
  Physical Surface("middle") = {a[5], h0[5]};
  Physical Surface("top") = {h0[4], h1[4], h2[4]};
  Physical Surface("front") = {1, 2, 61, 62, 63};
  Physical Surface("seat") = {h2[2]};
  Physical Surface("crown") = {b[4]};
EndIf
