// A small tyre that stands on the road, half of its width and half of its length: symmetric about y = 0 and x = 0. Its
// axle is the axis of y, and the road is below. Lengths in mm.
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
c = 50;           // from the axle to the middle of the section
inside = 11;      // radii of the section
outside = 14;
bead = 130 * Pi / 180;         // where the section ends at the rim
through = Ceil(2 * refine);          // elements through the wall
half = Ceil(7 * refine);              // along half of the section
below = Ceil(22 * refine);            // around the lower quarter
above = Ceil(11 * refine);            // around the upper one
Point(1) = {c, 0, 0};
Point(2) = {c + inside, 0, 0};
Point(3) = {c + outside, 0, 0};
Point(4) = {c + inside * Cos(bead), inside * Sin(bead), 0};
Point(5) = {c + outside * Cos(bead), outside * Sin(bead), 0};
Point(6) = {c + inside * Cos(bead / 2), inside * Sin(bead / 2), 0};
Point(7) = {c + outside * Cos(bead / 2), outside * Sin(bead / 2), 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 7};
Circle(3) = {7, 1, 5};
Line(4) = {5, 4};
Circle(5) = {4, 1, 6};
Circle(6) = {6, 1, 2};
Line(7) = {6, 7};
Transfinite Curve{1, 4, 7} = through + 1;
Transfinite Curve{2, 3, 5, 6} = half + 1;
Curve Loop(1) = {1, 2, -7, 6};
Plane Surface(1) = {1};
Curve Loop(2) = {7, 3, 4, 5};
Plane Surface(2) = {2};
Transfinite Surface{1, 2};
Recombine Surface{1, 2};
Rotate{ {0, 1, 0}, {0, 0, 0}, Pi / 2 }{ Surface{1, 2}; }
o[] = Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 }{ Surface{1, 2}; Layers{below}; Recombine; };
p[] = Extrude{ {0, 1, 0}, {0, 0, 0}, Pi / 2 }{ Surface{o[0], o[6]}; Layers{above}; Recombine; };
Physical Volume("tyre") = {o[1], o[7], p[1], p[7]};
Physical Surface("middle") = {o[2], p[2]};
Physical Surface("tread") = {o[3], o[9], p[3], p[9]};
Physical Surface("wall") = {o[5], o[11], p[5], p[11]};
Physical Surface("bead") = {o[10], p[10]};
Physical Surface("front") = {1, 2, p[0], p[6]};
