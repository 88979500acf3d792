// A coil spring of round wire, 1.75 turns. The section is in the plane of x and z. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
R = 8;            // of the coil's axis
r = 1.5;          // of the wire
pitch = 4.4;
n = 2 * Ceil(1.5 * refine);   // elements along a quarter of the wire
across = Ceil(2 * refine);    // from core to skin
along = Ceil(12 * refine);    // along half a turn
k = 0.5 * r / Sqrt(2);
c = r / Sqrt(2);
Point(1) = {R, 0, 0};
Point(2) = {R - k, 0, -k};
Point(3) = {R + k, 0, -k};
Point(4) = {R + k, 0, k};
Point(5) = {R - k, 0, k};
Point(6) = {R - c, 0, -c};
Point(7) = {R + c, 0, -c};
Point(8) = {R + c, 0, c};
Point(9) = {R - c, 0, c};
Line(1) = {2, 3};
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 2};
Circle(5) = {6, 1, 7};
Circle(6) = {7, 1, 8};
Circle(7) = {8, 1, 9};
Circle(8) = {9, 1, 6};
Line(9) = {2, 6};
Line(10) = {3, 7};
Line(11) = {4, 8};
Line(12) = {5, 9};
Transfinite Curve{1:8} = n + 1;
Transfinite Curve{9:12} = across + 1;
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {9, 5, -10, -1};
Curve Loop(3) = {10, 6, -11, -2};
Curve Loop(4) = {11, 7, -12, -3};
Curve Loop(5) = {12, 8, -9, -4};
s[] = {};
For i In {1:5}
  Plane Surface(i) = {i};
  Transfinite Surface{i};
  Recombine Surface{i};
EndFor
foot[] = {1:5};
last[] = foot[];
v[] = {};
skin[] = {};
For turn In {1:4}
  part = turn < 4 ? 1 : 0.5; // of half a turn
  o[] = Extrude{ {0, 0, part * pitch / 2}, {0, 0, 1}, {0, 0, 0}, part * Pi }{ Surface{last[]}; Layers{Ceil(part * along)}; Recombine; };
  last[] = {};
  For i In {0:4}
    last[] += {o[6 * i]};
    v[] += {o[6 * i + 1]};
  EndFor
  skin[] += {o[9], o[15], o[21], o[27]};
EndFor
Physical Volume("spring") = {v[]};
Physical Surface("skin") = {skin[]};
Physical Surface("foot") = {foot[]};
Physical Surface("head") = {last[]};
