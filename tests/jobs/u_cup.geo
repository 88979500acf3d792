// The section of a U-cup in its gland, in the plane: its lips stand out to either side, where a rod and a bore come.
// These and the gland's floor are curves. Lengths in mm.
DefineConstant[
  refine = {1, Name "divides all element sizes"},
  rod = {10, Name "where the rod ends up"}, bore = {14, Name "where the bore ends up"},
  apart = {0.5, Name "distance of both from there at the start"}
];
fine = 0.15 / refine;
coarse = 0.3 / refine;
Point(1) = {10.1, 0, 0, coarse};
Point(2) = {13.9, 0, 0, coarse};
Point(3) = {14, 0.4, 0, coarse};
Point(4) = {14, 2.5, 0, coarse};
Point(5) = {14.4, 5.6, 0, fine};
Point(6) = {14.1, 6, 0, fine};
Point(7) = {13.3, 6, 0, fine};
Point(8) = {12.4, 3, 0, fine};
Point(9) = {12, 2.7, 0, fine};
Point(10) = {11.6, 3, 0, fine};
Point(11) = {10.7, 6, 0, fine};
Point(12) = {9.9, 6, 0, fine};
Point(13) = {9.6, 5.6, 0, fine};
Point(14) = {10, 2.5, 0, coarse};
Point(15) = {10, 0.4, 0, coarse};
For i In {1 : 15}
  Line(i) = {i, i % 15 + 1};
EndFor
Curve Loop(1) = {1 : 15};
Plane Surface(1) = {1};

Point(31) = {rod - apart, 8, 0, coarse};
Point(32) = {rod - apart, -1, 0, coarse};
Point(33) = {bore + apart, 8, 0, coarse};
Point(34) = {bore + apart, -1, 0, coarse};
Point(35) = {9, 0, 0, coarse};
Point(36) = {15, 0, 0, coarse};
Line(31) = {31, 32};
Line(32) = {33, 34};
Line(33) = {35, 36};

Physical Surface("seal") = {1};
Physical Curve("skin") = {1 : 15};
Physical Curve("rod") = {31};
Physical Curve("bore") = {32};
Physical Curve("floor") = {33};
Physical Point("inlet") = {9};
