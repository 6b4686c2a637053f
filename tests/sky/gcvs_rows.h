#pragma once

namespace dmise::test {

/// Stars of the General Catalogue of Variable Stars 5.1 (Samus et al. 2017, ARep 61, 80) in the
/// form of its gcvs5.txt, with places of Hipparcos.
inline constexpr const char* gcvs_rows =
    "001995 |del   Cep *|222910.27 +582454.7 |DCEP      |   3.48  |    4.37    |            |V "
    "|55479.905   |     |    5.366208         |25   |F5Ib-G1Ib        |\n"
    "002107 |omi   Cet *|021920.78 -025839.4 |M         |    2.0  |   10.1     |            |V "
    "|44839.      |     |    331.96           |38   |M5e-M9e          |\n"
    "004094 |RR    Lyr *|192527.91 +424703.8 |RRAB      |   7.06  |    8.12    |            |V "
    "|42923.4193  |     |    0.56686776       |19   |A5.0-F7.0        |\n"
    "004145 |bet   Lyr *|185004.80 +332145.7 |EB        |   3.25  |    4.36    |    3.85    |V "
    "|08247.950   |     |    12.913834        |     |B8II-IIIep       |\n"
    "004695 |alf   Ori *|055510.30 +072425.6 |SRC       |    0.0  |    1.3     |            |V "
    "|            |     |    2335.            |     |M1-M2Ia-Ibe      |\n"
    "005065 |bet   Per *|030810.13 +405720.2 |EA/SD     |   2.12  |    3.39    |            |V "
    "|45641.5135  |     |    2.8673043        |14   |B8V              |\n"
    "006304 |W     UMa *|094345.48 +555709.0 |EW/KW     |   7.75  |    8.48    |    8.43    |V "
    "|45765.7385  |     |    0.33363749       |     |F8Vp+F8Vp        |\n"
    "000966 |ST    CVn *|135734.06 +295128.8 |RRC       |  11.04  |   11.60    |            |V "
    "|51334.7466  |     |    0.3290568        |43   |A1               |\n"
    "001619 |T     Cen *|134145.55 -333550.6 |SR        |    5.5  |    9.0     |            |V "
    "|48575.3     |     |    90.43            |47   |K0:e-M4II:e      |\n";

}  // namespace dmise::test
