from app.pages.reports import Material


def test_a_result_without_a_service_has_its_motions_and_no_job(material: Material) -> None:
    cycles = material.found.rows("limit_cycles")
    assert len(material.motions) == len(material.orbits) > 0
    for motion in material.motions:
        size = 0.5 * (max(motion.vertical) - min(motion.vertical))
        expected = cycles[motion.number]["vertical_m"]
        assert abs(size - expected) < 0.02 * expected + 1e-6
    assert material.job == {}
    assert material.found.verdict == material.found.rows("verdict")[0]
