// A cone clutch: ring with a conical bore pressed on a cone. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
a = 12 * Pi / 180; l = 10; R = 40; t = 8; n = 20 * refine; m = 2 * refine;
Function Body
  Point(b + 1) = {r0, z0, 0}; Point(b + 2) = {r1, z0, 0}; Point(b + 3) = {r3, z1, 0}; Point(b + 4) = {r2, z1, 0};
  For i In {1 : 4}
    Line(b + i) = {b + i, b + i % 4 + 1};
  EndFor
  Curve Loop(b + 1) = {b + 1 : b + 4}; Plane Surface(b + 1) = {b + 1};
  Transfinite Curve{b + 1, b + 3} = m + 1; Transfinite Curve{b + 2, b + 4} = k + 1;
  Transfinite Surface{b + 1}; Recombine Surface{b + 1};
  q() = Extrude { {0, 1, 0}, {0, 0, 0}, 2 * Pi / 3 } { Surface{b + 1}; Layers{nn}; Recombine; };
  q2() = Extrude { {0, 1, 0}, {0, 0, 0}, 2 * Pi / 3 } { Surface{q(0)}; Layers{nn}; Recombine; };
  q3() = Extrude { {0, 1, 0}, {0, 0, 0}, 2 * Pi / 3 } { Surface{q2(0)}; Layers{nn}; Recombine; };
Return
// cone: its flank from (R, 0) inward as z grows; ring outside of it, shorter
b = 0; r0 = R - 15; r1 = R; r2 = R - 15; r3 = R - l * Tan(a); z0 = 0; z1 = l; k = 5 * refine; nn = 11 * refine; Call Body;
Physical Volume("cone") = {q(1), q2(1), q3(1)}; Physical Surface("flank") = {q(3), q2(3), q3(3)}; Physical Surface("bore") = {q(5), q2(5), q3(5)};
b = 100; z0 = 2; z1 = 8; r0 = R - z0 * Tan(a); r1 = R + t; r2 = R - z1 * Tan(a); r3 = R + t; k = 3 * refine; nn = 12 * refine; Call Body;
Physical Volume("ring") = {q(1), q2(1), q3(1)}; Physical Surface("lining") = {q(5), q2(5), q3(5)}; Physical Surface("rim") = {q(3), q2(3), q3(3)}; Physical Surface("back") = {q(4), q2(4), q3(4)};
