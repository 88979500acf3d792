// Hose on a spigot under a band clamp, right half, plane strain
DefineConstant[ refine = {1, Name "divides all element sizes"} ];
h = 0.8/refine;
Point(1) = {0,0,0,h};
Macro Arc2   // half ring ra..rb, surface s
  Point(s+1) = {0,-ra,0,h}; Point(s+2) = {ra,0,0,h}; Point(s+3) = {0,ra,0,h};
  Point(s+4) = {0,rb,0,h}; Point(s+5) = {rb,0,0,h}; Point(s+6) = {0,-rb,0,h};
  Circle(s+1) = {s+1,1,s+2}; Circle(s+2) = {s+2,1,s+3}; Line(s+3) = {s+3,s+4}; Circle(s+4) = {s+4,1,s+5}; Circle(s+5) = {s+5,1,s+6}; Line(s+6) = {s+6,s+1};
  Curve Loop(s) = {s+1:s+6}; Plane Surface(s) = {s};
Return
s = 100; ra = 8; rb = 10; Call Arc2;
s = 200; ra = 10; rb = 14; Call Arc2;
// band
ri = 14; ro = 15; xe = 2; 
Point(301) = {0,-ri,0,h}; Point(302) = {ri,0,0,h}; Point(303) = {xe, Sqrt(ri^2-xe^2),0,h/2};
Point(304) = {xe, 21, 0, h/2}; Point(305) = {xe+1, 21, 0, h/2}; Point(306) = {xe+1, Sqrt(ro^2-(xe+1)^2), 0, h/2}; Point(307) = {ro,0,0,h}; Point(308) = {0,-ro,0,h};
Circle(301) = {301,1,302}; Circle(302) = {302,1,303}; Line(303) = {303,304}; Line(304) = {304,305}; Line(305) = {305,306}; Circle(306) = {306,1,307}; Circle(307) = {307,1,308}; Line(308) = {308,301};
Curve Loop(300) = {301:308}; Plane Surface(300) = {300};
Physical Surface("spigot") = {100}; Physical Surface("hose") = {200}; Physical Surface("band") = {300};
Physical Curve("middle") = {103,106,203,206,308};
Physical Curve("spigot_bore") = {101,102}; Physical Curve("spigot_skin") = {104,105}; Physical Curve("hose_bore") = {201,202}; Physical Curve("hose_skin") = {204,205};
Physical Curve("band_bore") = {301,302,303}; Physical Curve("ear") = {304};
