// A brake pad, a sector of a ring, on a sector of a disc. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
Macro Ring
  Point(b+1) = {r0*Cos(f0), r0*Sin(f0), z}; Point(b+2) = {r1*Cos(f0), r1*Sin(f0), z};
  Line(b+1) = {b+1, b+2}; Transfinite Curve{b+1} = nr + 1;
  q() = Extrude { {0, 0, 1}, {0, 0, 0}, f1 - f0 } { Curve{b+1}; Layers{nf}; Recombine; };
  v() = Extrude {0, 0, h} { Surface{q(1)}; Layers{nz}; Recombine; };
Return
b = 100; r0 = 50; r1 = 90; f0 = -Pi/3; f1 = Pi/3; z = -8; h = 8; nr = Round(8*refine); nf = Round(20*refine); nz = Round(2*refine); Call Ring;
Physical Volume("disc") = {v(1)}; Physical Surface("track") = {v(0)}; Physical Surface("back") = {q(1)};
b = 200; r0 = 60; r1 = 80; f0 = -Pi/8; f1 = Pi/8; z = 0; h = 6; nr = Round(5*refine); nf = Round(9*refine); nz = Round(2*refine); Call Ring;
Physical Volume("pad") = {v(1)}; Physical Surface("plate") = {v(0)}; Physical Surface("lining") = {q(1)};
