// Meridians of two half balls of radius 10 that touch in the origin (x: radius, y: axis), or of the upper one alone. Within twice the
// contact radius, which is 1, elements are even and in rows; farther away they grow. The meshes do not match at the interface.
DefineConstant[
  n_lower = {14, Name "elements over two contact radii, lower ball; 0: the upper ball alone"},
  n_upper = {18, Name "elements over two contact radii, upper ball"}
];
R = 10;
block = 2;
away = 1.5;   // size of elements at the equators
height = R - Sqrt(R^2 - block^2);   // of the skin at the block's end
n[] = {n_lower, n_upper};
For b In {(n_lower ? 0 : 1) : 1}
  o = 20 * b;
  side = (b == 0) ? -1 : 1;
  size = block / n[b];
  Point(o + 1) = {0, side * R, 0, away};
  Point(o + 2) = {R, side * R, 0, away};
  Point(o + 3) = {block, side * height, 0, size};
  Point(o + 4) = {0, 0, 0, size};
  Point(o + 5) = {0, side * block, 0, size};
  Point(o + 6) = {block, side * block, 0, size};
  Line(o + 1) = {o + 1, o + 2};
  Circle(o + 2) = {o + 2, o + 1, o + 3};
  Circle(o + 3) = {o + 3, o + 1, o + 4};
  Line(o + 4) = {o + 4, o + 5};
  Line(o + 5) = {o + 5, o + 1};
  Line(o + 6) = {o + 5, o + 6};
  Line(o + 7) = {o + 6, o + 3};
  Curve Loop(o + 1) = {o + 3, o + 4, o + 6, o + 7};
  Plane Surface(o + 1) = {o + 1};
  Curve Loop(o + 2) = {o + 1, o + 2, -(o + 7), -(o + 6), o + 5};
  Plane Surface(o + 2) = {o + 2};
  Transfinite Curve{o + 3, o + 4, o + 6, o + 7} = n[b] + 1;
  Transfinite Surface{o + 1};
  Recombine Surface{o + 1, o + 2};
EndFor
If (n_lower)
  Physical Surface("lower") = {1, 2};
  Physical Curve("lower_base") = {1};
  Physical Curve("lower_skin") = {2, 3};
  Physical Curve("lower_axis") = {4, 5};
EndIf
Physical Surface("upper") = {21, 22};
Physical Curve("upper_base") = {21};
Physical Curve("upper_skin") = {22, 23};
Physical Curve("upper_axis") = {24, 25};
