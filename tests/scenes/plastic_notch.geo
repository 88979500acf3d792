// A quarter of a strip with a round hole in its middle, or with round notches in its sides. Millimetres.
DefineConstant[
  notch = {0, Name "1: notches in the sides"}, n = {8, Name "elements along a quarter of the hole (even)"},
  n_out = {12, Name "elements away from the hole"}, n_far = {6, Name "elements beyond the square around the hole"}
];
r = 5;  // of the hole
w = 10; // half width
l = 18; // half length
c = notch ? w : 0; // centre of the arc, its other end towards -x where it is a notch
s = notch ? -1 : 1;
Point(1) = {c, 0, 0};
Point(2) = {c + s * r, 0, 0};
Point(3) = {c + s * r * Cos(Pi / 4), r * Sin(Pi / 4), 0};
Point(4) = {c, r, 0};
Point(5) = {c + s * w, 0, 0};
Point(6) = {c + s * w, w, 0};
Point(7) = {c, w, 0};
Point(8) = {c + s * w, l, 0};
Point(9) = {c, l, 0};
Circle(1) = {2, 1, 3};
Circle(2) = {3, 1, 4};
Line(3) = {2, 5};
Line(4) = {3, 6};
Line(5) = {4, 7};
Line(6) = {5, 6};
Line(7) = {6, 7};
Line(8) = {6, 8};
Line(9) = {7, 9};
Line(10) = {8, 9};
Curve Loop(1) = {3, 6, -4, -1};
Curve Loop(2) = {4, 7, -5, -2};
Curve Loop(3) = {8, 10, -9, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
Transfinite Curve{1, 2, 6, 7, 10} = n / 2 + 1;
Transfinite Curve{3, 4, 5} = n_out + 1 Using Progression 1.08;
Transfinite Curve{8, 9} = n_far + 1;
Transfinite Surface{1, 2, 3};
Recombine Surface{1, 2, 3};
Physical Surface("strip") = {1, 2, 3};
Physical Curve("middle") = {3};
Physical Curve("centre") = {notch ? 6 : 5, notch ? 8 : 9};
Physical Curve("end") = {10};
