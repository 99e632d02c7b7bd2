// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "city/sky/calendar.h"
#include "city/sky/clear_sky.h"
#include "city/sky/solar_position.h"

namespace helio {
namespace {

TEST(Calendar, JulianDays)
{
    // NREL/TP-560-34302, table A4.1.
    EXPECT_EQ(julianDay(2000, 1, 1, 12.0), 2451545.0);
    EXPECT_EQ(julianDay(1999, 1, 1, 0.0), 2451179.5);
    EXPECT_EQ(julianDay(1987, 1, 27, 0.0), 2446822.5);
    EXPECT_EQ(julianDay(1987, 6, 19, 12.0), 2446966.0);
    EXPECT_EQ(julianDay(1988, 1, 27, 0.0), 2447187.5);
    EXPECT_EQ(julianDay(1900, 1, 1, 0.0), 2415020.5);
    EXPECT_EQ(julianDay(1600, 12, 31, 0.0), 2305812.5);
    for (int year = 1600; year < 2999; ++year)
        EXPECT_EQ(julianDay(year, 3, 1, 0.0) - julianDay(year, 2, 28, 0.0),
                  (year % 4 == 0 && year % 100 != 0) || year % 400 == 0 ? 2.0 : 1.0)
            << year;
}

TEST(Calendar, ReadsDatesAndTimes)
{
    EXPECT_EQ(*parseJulianDay("2000-01-01", "12:00", 0.0), 2451545.0);
    EXPECT_NEAR(*parseJulianDay("2003-10-17", "12:30:30", -7.0), 2452930.312847, 5e-7); // table A5.1
    EXPECT_EQ(*parseJulianDay("2026-06-21", "01:00", 2.0), julianDay(2026, 6, 20, 23.0));
    EXPECT_TRUE(parseJulianDay("2024-02-29", "00:00", 0.0).ok());
    for (const char* date : {"", "2026-6-21", "2026-06-31", "2026-02-29", "1900-02-29", "2026-13-01", "2026-00-10",
                             "2026-01-00", "1599-12-31", "3000-01-01", "2026/06/21", "2026-06-21 ", "-026-06-21"})
        EXPECT_FALSE(parseJulianDay(date, "12:00", 0.0).ok()) << date;
    for (const char* time : {"", "1230", "24:00", "12:60", "12:00:60", "12:00:0", "1 :00", "+1:00"})
        EXPECT_FALSE(parseJulianDay("2026-06-21", time, 0.0).ok()) << time;
    EXPECT_EQ(parseJulianDay("2026-02-29", "12:00", 0.0).error().message,
              "date 2026-02-29: expected YYYY-MM-DD, 1600-01-01 to 2999-12-31, such as 2026-06-21");
}

TEST(SolarPosition, TestVectorOfTheReport)
{
    // NREL/TP-560-34302, table A5.1: zenith 50.11162, azimuth 194.34024, distance 0.9965422974.
    const SunPosition sun = sunPosition(*parseJulianDay("2003-10-17", "12:30:30", -7.0),
                                        {39.742476, -105.1786, 1830.14, 820.0, 11.0}, 67.0);
    EXPECT_NEAR(90.0 - sun.elevationDeg, 50.11162, 6e-6);
    EXPECT_NEAR(sun.azimuthDeg, 194.34024, 6e-6);
    EXPECT_NEAR(sun.distance, 0.9965422974, 6e-11);
}

TEST(SolarPosition, AgreesWithAnotherImplementation)
{
    // pvlib 0.16.1, spa.solar_position_numpy: both hemispheres, the tropics, before sunrise, past and future.
    struct Row
    {
        const char *date, *time;
        Site site;
        double deltaT, elevation, trueElevation, azimuth;
    };
    const Row rows[] = {
        {"2026-06-21", "12:30", {50.0875, 14.4213, 200, 990, 12}, 69, 58.540929, 58.530866, 220.029277},
        {"2026-12-21", "20:00", {-33.8688, 151.2093, 20, 1010, 18}, 69, 14.161351, 14.098037, 108.984879},
        {"1950-02-28", "06:15", {51.9225, 4.47917, 0, 1013.25, 5}, 29, -3.335813, -3.335813, 98.989219},
        {"2080-11-05", "23:59:59", {1.29, 103.85, 15, 1010, 28}, 69, 16.890144, 16.838853, 107.338552}};
    for (const Row& row : rows) {
        const SunPosition sun = sunPosition(*parseJulianDay(row.date, row.time, 0.0), row.site, row.deltaT);
        EXPECT_NEAR(sun.elevationDeg, row.elevation, 5e-6) << row.date;
        EXPECT_NEAR(sun.trueElevationDeg, row.trueElevation, 5e-6) << row.date;
        EXPECT_NEAR(sun.azimuthDeg, row.azimuth, 5e-6) << row.date;
    }
}

TEST(SolarPosition, EquinoxAtThePole)
{
    // The March equinox of 2024 was on the 20th at 03:06 UTC: seen from the pole the sun's centre is the parallax of
    // 8.8" below the horizon, give or take the half minute that the time is rounded by (0.016 degrees an hour).
    const SunPosition sun = sunPosition(*parseJulianDay("2024-03-20", "03:06", 0.0), {90.0, 0.0});
    EXPECT_NEAR(sun.trueElevationDeg, -8.8 / 3600.0, 3e-4);
    // Refraction lifts a sun at the horizon by about half a degree (Bennett: 34.5' at 1010 hPa and 10 degrees).
    const SunPosition cold = sunPosition(*parseJulianDay("2024-03-20", "03:06", 0.0), {90.0, 0.0, 0.0, 1010.0, 10.0});
    EXPECT_NEAR(cold.elevationDeg - cold.trueElevationDeg, 0.48, 0.02);
}

TEST(SolarPosition, PressureOfTheStandardAtmosphere)
{
    EXPECT_EQ(standardPressure(0.0), 1013.25);
    EXPECT_NEAR(standardPressure(1000.0), 898.75, 0.02); // ISO 2533
    EXPECT_NEAR(standardPressure(5000.0), 540.20, 0.02);
}

TEST(ClearSky, AgreesWithAnotherImplementation)
{
    // pvlib 0.16.1, clearsky.ineichen with get_relative_airmass(..., "kastenyoung1989"), 1361 W/m2.
    struct Row
    {
        double elevation, turbidity, height, pressure, dni, dhi;
    };
    const Row rows[] = {{60, 3, 0, 1013.25, 914.434477, 102.869063},
                        {10, 4.5, 200, 990, 202.709926, 40.746213},
                        {35, 2, 1600, 835, 1032.450877, 39.712905},
                        {2, 3, 0, 1013.25, 34.057160, 3.130012}};
    for (const Row& row : rows) {
        const ClearSky sky = clearSky(row.elevation, row.turbidity, row.height, row.pressure, 1361.0);
        EXPECT_NEAR(sky.dni, row.dni, 1e-5) << row.elevation;
        EXPECT_NEAR(sky.dhi, row.dhi, 1e-5) << row.elevation;
    }
    EXPECT_EQ(clearSky(0.0, 3.0, 0.0, 1013.25, 1361.0).dni, 0.0);
    EXPECT_EQ(clearSky(-5.0, 3.0, 0.0, 1013.25, 1361.0).dhi, 0.0);
}

} // namespace
} // namespace helio
