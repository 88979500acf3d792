// A ring with little play over a shaft and in a sleeve. Lengths in mm.
play = 0.02;
Point(1) = {0, 0, 0};
radius() = {8 - play, 8, 10, 10 + play};
For i In {0 : 3}
  p = newp; r = radius(i);
  Point(p) = {r, 0, 0}; Point(p + 1) = {0, r, 0}; Point(p + 2) = {-r, 0, 0}; Point(p + 3) = {0, -r, 0};
  c = 10 * (i + 1);
  Circle(c) = {p, 1, p + 1}; Circle(c + 1) = {p + 1, 1, p + 2}; Circle(c + 2) = {p + 2, 1, p + 3};
  Circle(c + 3) = {p + 3, 1, p};
  Transfinite Curve{c : c + 3} = 13;
EndFor
Curve Loop(1) = {30 : 33}; Curve Loop(2) = {20 : 23}; Plane Surface(1) = {1, 2};
Mesh.MeshSizeMax = 1;
Physical Surface("ring") = {1};
Physical Curve("shaft") = {10 : 13}; Physical Curve("bore") = {20 : 23}; Physical Curve("rim") = {30 : 33};
Physical Curve("sleeve") = {40 : 43};
