BEGIN TRANSACTION;
CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
);
INSERT INTO "alembic_version" VALUES('0021');
CREATE TABLE api_keys (
	id CHAR(32) NOT NULL, 
	created_at DATETIME NOT NULL, 
	expires_at DATETIME, 
	revoked_at DATETIME, 
	used_at DATETIME, 
	owner VARCHAR(64) NOT NULL, 
	name TEXT, 
	prefix VARCHAR(32) NOT NULL, 
	digest VARCHAR(64) NOT NULL, 
	scopes JSON NOT NULL, 
	CONSTRAINT pk_api_keys PRIMARY KEY (id), 
	CONSTRAINT uq_api_keys_digest UNIQUE (digest)
);
CREATE TABLE audit_events (
	id CHAR(32) NOT NULL, 
	at DATETIME NOT NULL, 
	owner VARCHAR(64) NOT NULL, 
	key_id CHAR(32), 
	action VARCHAR(32) NOT NULL, 
	subject CHAR(32), 
	detail TEXT, 
	CONSTRAINT pk_audit_events PRIMARY KEY (id)
);
INSERT INTO "audit_events" VALUES('01a22c61867a7586b085991578ebca41','2026-11-30 12:15:18.624272','local',NULL,'job_submitted','01a22c618660709a82c0a13c48c5b54d',NULL);
INSERT INTO "audit_events" VALUES('01a22c618d6a73c1af33d58c7c2cc11d','2026-11-30 12:15:20.423445','local',NULL,'batch_submitted','01a22c618d60718ea1c1abd65411f6ad','2 lines');
INSERT INTO "audit_events" VALUES('01a22c618e0c735b876c3a2867afb2ca','2026-11-30 12:15:20.573708','local',NULL,'job_submitted','01a22c618dfd76c7a88de28d09fd8fe8',NULL);
INSERT INTO "audit_events" VALUES('01a22c61966e736ba7d4eb1fcff7473b','2026-11-30 12:15:22.732920','local',NULL,'job_submitted','01a22c61966c7006abde99b23669f9f4',NULL);
INSERT INTO "audit_events" VALUES('01a22c6196e973f09a8fb2e11b6feea2','2026-11-30 12:15:22.825771','local',NULL,'batch_submitted','01a22c619681710fb3a2b8734bbf5de4','3 lines');
CREATE TABLE batch_items (
	batch_id CHAR(32) NOT NULL, 
	number INTEGER NOT NULL, 
	chunk_id CHAR(32), 
	reference TEXT, 
	asset_id TEXT, 
	document JSON, 
	faults JSON, known JSON, geometry JSON, computed JSON, 
	CONSTRAINT pk_batch_items PRIMARY KEY (batch_id, number), 
	CONSTRAINT ck_batch_items_faults_or_chunk CHECK ((faults IS NULL) = (chunk_id IS NOT NULL)), 
	CONSTRAINT ck_batch_items_faults_or_document CHECK ((faults IS NULL) = (document IS NOT NULL)), 
	CONSTRAINT fk_batch_items_batches FOREIGN KEY(batch_id) REFERENCES batches (id) ON DELETE CASCADE
);
INSERT INTO "batch_items" VALUES('01a22c618d60718ea1c1abd65411f6ad',1,'01a22c618d6677199255854b42ad9839',NULL,NULL,'{"name":"line 0","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":28000.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null}',NULL,NULL,NULL,NULL);
INSERT INTO "batch_items" VALUES('01a22c618d60718ea1c1abd65411f6ad',2,'01a22c618d6677199255854b42ad9839',NULL,NULL,'{"name":"line 1","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":28007.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null}',NULL,NULL,NULL,NULL);
INSERT INTO "batch_items" VALUES('01a22c619681710fb3a2b8734bbf5de4',1,'01a22c6196907050850d7003c4dff370',NULL,NULL,'{"name":"line 0","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":28300.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null}',NULL,NULL,NULL,NULL);
INSERT INTO "batch_items" VALUES('01a22c619681710fb3a2b8734bbf5de4',2,'01a22c6196907050850d7003c4dff370',NULL,NULL,'{"name":"line 1","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":28307.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null}',NULL,NULL,NULL,NULL);
INSERT INTO "batch_items" VALUES('01a22c619681710fb3a2b8734bbf5de4',3,'01a22c6196907050850d7003c4dff370',NULL,NULL,'{"name":"line 2","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":28314.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null}',NULL,NULL,NULL,NULL);
CREATE TABLE batches (
	id CHAR(32) NOT NULL, 
	created_at DATETIME NOT NULL, 
	received_at DATETIME, 
	analysis JSON NOT NULL, 
	rejected_lines INTEGER NOT NULL, owner VARCHAR(64) DEFAULT 'local' NOT NULL, notes JSON, 
	CONSTRAINT pk_batches PRIMARY KEY (id)
);
INSERT INTO "batches" VALUES('01a22c618d60718ea1c1abd65411f6ad','2026-11-30 12:15:20.416993','2026-11-30 12:15:20.423445','{"loops":[1],"models":["hybrid"],"wind_speeds_m_per_s":[4.0,6.0],"closure":"exact","physics":null,"aerodynamic_model":null,"aerodynamic_load":"expanded","longitudinal_inertia":null,"stretching":null,"critical_wind_limit_m_per_s":30.0,"harmonics":5,"finite_element_loops":[1,2,3],"static_twist":null,"loop_competition":"neglected","device_effect":"neglected","amplitude_curves":"neglected","quasi_periodic":"lasting","check":"none","risk":null,"uncertainty":null}',0,'local',NULL);
INSERT INTO "batches" VALUES('01a22c619681710fb3a2b8734bbf5de4','2026-11-30 12:15:22.753956','2026-11-30 12:15:22.825771','{"loops":[1],"models":["hybrid"],"wind_speeds_m_per_s":[4.0,6.0],"closure":"exact","physics":null,"aerodynamic_model":null,"aerodynamic_load":"expanded","longitudinal_inertia":null,"stretching":null,"critical_wind_limit_m_per_s":30.0,"harmonics":5,"finite_element_loops":[1,2,3],"static_twist":null,"loop_competition":"neglected","device_effect":"neglected","amplitude_curves":"neglected","quasi_periodic":"lasting","check":"none","risk":null,"uncertainty":null}',0,'local',NULL);
CREATE TABLE idempotency_keys (
	owner VARCHAR(64) NOT NULL, 
	"key" VARCHAR(255) NOT NULL, 
	expires_at DATETIME NOT NULL, 
	holder CHAR(32) NOT NULL, 
	fingerprint VARCHAR(64), 
	status INTEGER, 
	headers JSON, 
	body TEXT, 
	CONSTRAINT pk_idempotency_keys PRIMARY KEY (owner, "key"), 
	CONSTRAINT ck_idempotency_keys_status_with_body CHECK ((status IS NULL) = (body IS NULL)), 
	CONSTRAINT ck_idempotency_keys_status_with_fingerprint CHECK ((status IS NULL) = (fingerprint IS NULL))
);
CREATE TABLE job_events (
	id INTEGER NOT NULL, 
	job_id CHAR(32) NOT NULL, 
	at DATETIME NOT NULL, 
	kind VARCHAR(32) NOT NULL, 
	attempt INTEGER NOT NULL, 
	detail TEXT, 
	CONSTRAINT pk_job_events PRIMARY KEY (id), 
	CONSTRAINT fk_job_events_jobs FOREIGN KEY(job_id) REFERENCES jobs (id) ON DELETE CASCADE, 
	CONSTRAINT ck_job_events_kind CHECK (kind IN ('accepted', 'running', 'released', 'cancel_requested', 'successful', 'failed', 'dismissed'))
);
INSERT INTO "job_events" VALUES(1,'01a22c618660709a82c0a13c48c5b54d','2026-11-30 12:15:18.624272','accepted',0,NULL);
INSERT INTO "job_events" VALUES(2,'01a22c618660709a82c0a13c48c5b54d','2026-11-30 12:15:20.192589','running',1,'host:456:1c19c560');
INSERT INTO "job_events" VALUES(3,'01a22c618660709a82c0a13c48c5b54d','2026-11-30 12:15:20.356644','successful',1,NULL);
INSERT INTO "job_events" VALUES(4,'01a22c618d6677199255854b42ad9839','2026-11-30 12:15:20.423445','accepted',0,NULL);
INSERT INTO "job_events" VALUES(5,'01a22c618d6677199255854b42ad9839','2026-11-30 12:15:20.466721','running',1,'host:456:1c19c560');
INSERT INTO "job_events" VALUES(6,'01a22c618d6677199255854b42ad9839','2026-11-30 12:15:20.531044','successful',1,NULL);
INSERT INTO "job_events" VALUES(7,'01a22c618dfd76c7a88de28d09fd8fe8','2026-11-30 12:15:20.573708','accepted',0,NULL);
INSERT INTO "job_events" VALUES(8,'01a22c618dfd76c7a88de28d09fd8fe8','2026-11-30 12:15:20.614141','running',1,'host:456:1c19c560');
INSERT INTO "job_events" VALUES(9,'01a22c61966c7006abde99b23669f9f4','2026-11-30 12:15:22.732920','accepted',0,NULL);
INSERT INTO "job_events" VALUES(10,'01a22c6196907050850d7003c4dff370','2026-11-30 12:15:22.825771','accepted',0,NULL);
CREATE TABLE job_tags (
	job_id CHAR(32) NOT NULL, 
	"key" TEXT NOT NULL, 
	value TEXT NOT NULL, 
	CONSTRAINT pk_job_tags PRIMARY KEY (job_id, "key"), 
	CONSTRAINT fk_job_tags_jobs FOREIGN KEY(job_id) REFERENCES jobs (id) ON DELETE CASCADE
);
INSERT INTO "job_tags" VALUES('01a22c618660709a82c0a13c48c5b54d','source','c11');
INSERT INTO "job_tags" VALUES('01a22c618dfd76c7a88de28d09fd8fe8','source','c11');
INSERT INTO "job_tags" VALUES('01a22c61966c7006abde99b23669f9f4','source','c11');
CREATE TABLE jobs (
	id CHAR(32) NOT NULL, 
	created_at DATETIME NOT NULL, 
	started_at DATETIME, 
	finished_at DATETIME, 
	status VARCHAR(32) NOT NULL, 
	progress DOUBLE NOT NULL, 
	step TEXT NOT NULL, 
	attempt INTEGER NOT NULL, 
	lease_owner TEXT, 
	lease_expires_at DATETIME, 
	cancel_requested BOOLEAN NOT NULL, 
	dispatched_at DATETIME, 
	failure_kind VARCHAR(32), 
	failure_detail TEXT, 
	name TEXT, 
	asset_id TEXT, 
	batch_id CHAR(32), 
	document JSON NOT NULL, 
	input_hash VARCHAR(64) NOT NULL, 
	engine_version VARCHAR(64), lines INTEGER, failed_lines INTEGER, owner VARCHAR(64) DEFAULT 'local' NOT NULL, request_id VARCHAR(128), trace_parent VARCHAR(55), reused_from CHAR(32), reused_lines INTEGER, 
	CONSTRAINT pk_jobs PRIMARY KEY (id), 
	CONSTRAINT ck_jobs_failed_with_kind CHECK ((status = 'failed') = (failure_kind IS NOT NULL)), 
	CONSTRAINT ck_jobs_running_with_lease CHECK ((status = 'running') = (lease_expires_at IS NOT NULL)), 
	CONSTRAINT ck_jobs_status CHECK (status IN ('accepted', 'running', 'successful', 'failed', 'dismissed')), 
	CONSTRAINT ck_jobs_failure_kind CHECK (failure_kind IN ('input', 'no_convergence', 'time_limit', 'worker_lost', 'internal'))
);
INSERT INTO "jobs" VALUES('01a22c618660709a82c0a13c48c5b54d','2026-11-30 12:15:18.624272','2026-11-30 12:15:20.173599','2026-11-30 12:15:20.352858','successful',1.0,'',1,NULL,NULL,0,'2026-11-30 12:15:18.767844',NULL,NULL,'C11 single, 126 m',NULL,NULL,'{"line":{"name":"C11 single, 126 m","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":1,"radius_m":0.0,"orientation_deg":null,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":30000.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null},"analysis":{"loops":[1],"models":["hybrid"],"wind_speeds_m_per_s":[4.0],"closure":"exact","physics":null,"aerodynamic_model":null,"aerodynamic_load":"expanded","longitudinal_inertia":null,"stretching":null,"critical_wind_limit_m_per_s":30.0,"harmonics":5,"finite_element_loops":[1,2,3],"static_twist":null,"loop_competition":"neglected","device_effect":"neglected","amplitude_curves":"neglected","quasi_periodic":"lasting","check":"none","risk":null,"uncertainty":null}}','1b344bbd4de5c073df7875a016f3f38a2aa90f099bdc3f59335e81a6c63bebe6','0.6.0',NULL,NULL,'local','01a22c61-8600-7779-aeb5-003ae31eb4ba',NULL,NULL,NULL);
INSERT INTO "jobs" VALUES('01a22c618d6677199255854b42ad9839','2026-11-30 12:15:20.423445','2026-11-30 12:15:20.465187','2026-11-30 12:15:20.529193','successful',1.0,'',1,NULL,NULL,0,'2026-11-30 12:15:20.445378',NULL,NULL,NULL,NULL,'01a22c618d60718ea1c1abd65411f6ad','{"batch_id":"01a22c61-8d60-718e-a1c1-abd65411f6ad","part":1}','64d56c2d1b2da9e511b12b38abd8e38ba4ab66efc51490420c79b4d849c57a60','0.6.0',2,0,'local','01a22c61-8d5d-708d-a3c2-eacdbaebec8a',NULL,NULL,0);
INSERT INTO "jobs" VALUES('01a22c618dfd76c7a88de28d09fd8fe8','2026-11-30 12:15:20.573708','2026-11-30 12:15:20.612670',NULL,'running',0.5,'point 2 of 3: limit cycles of the finite element model',1,'host:456:1c19c560','2026-11-30 12:15:27.632178',0,'2026-11-30 12:15:20.597491',NULL,NULL,'was running',NULL,NULL,'{"line":{"name":"was running","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":2,"radius_m":0.2355,"orientation_deg":90.0,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":30000.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null},"analysis":{"loops":[1,2],"models":["hybrid","finite_element"],"wind_speeds_m_per_s":{"start":3.0,"stop":12.0,"count":20},"closure":"exact","physics":null,"aerodynamic_model":null,"aerodynamic_load":"expanded","longitudinal_inertia":null,"stretching":null,"critical_wind_limit_m_per_s":30.0,"harmonics":5,"finite_element_loops":[1,2,3],"static_twist":null,"loop_competition":"neglected","device_effect":"neglected","amplitude_curves":"neglected","quasi_periodic":"lasting","check":"none","risk":null,"uncertainty":null},"study":{"axes":[{"parameter":"span.horizontal_tension_n","also":[],"values":[25000.0,25100.0,25200.0]}],"follow":false}}','d45a39d3a27c3f0cc35ef9ba27dd9c8ee2e3a5374626838128c16cd2e1904fb3',NULL,NULL,NULL,'local','01a22c61-8dfa-764d-b38a-32f23fe7c3f4',NULL,NULL,NULL);
INSERT INTO "jobs" VALUES('01a22c61966c7006abde99b23669f9f4','2026-11-30 12:15:22.732920',NULL,NULL,'accepted',0.0,'',0,NULL,NULL,0,'2026-11-30 12:15:22.783401',NULL,NULL,'C11 single, 126 m',NULL,NULL,'{"line":{"name":"C11 single, 126 m","asset_id":null,"tags":{"source":"c11"},"conductor":{"diameter_m":0.0286,"axial_rigidity_n":28418105.783999998,"area_m2":null,"youngs_modulus_pa":null,"torsional_rigidity_n_m2":101.0,"axial_torsional_coupling_n_m":0.0,"mass_kg_per_m":2.379,"polar_inertia_kg_m":0.0003334,"rated_strength_n":null},"bundle":{"subconductors":1,"radius_m":0.0,"orientation_deg":null,"positions_m":null,"section":null},"span":{"length_m":125.88,"horizontal_tension_n":30000.0,"catenary_parameter_m":null,"sag_m":null,"level_difference_m":0.0,"elements":10},"supports":{"longitudinal_stiffness_n_per_m":null,"left":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null},"right":{"dead_end":false,"adjacent_span_m":null,"insulator_length_m":null,"insulator_weight_n":0.0,"yoke":null}},"ice":{"eccentricity_y_m":0.00205,"eccentricity_z_m":-0.00063,"aerodynamics":{"vertical":[-0.1667,-4.0547,8.3581],"horizontal":[0.8605,0.8325,1.7815],"torsional":[-0.7272,0.2935,5.9704],"fitted_range_deg":null},"aerodynamics_at_rest":null,"segments":[]},"wind":{"air_density_kg_per_m3":1.2929,"blow_out":null,"yaw_deg":0.0,"profile":[]},"damping":{"vertical_ratio":0.000515,"horizontal_ratio":0.000515,"torsional_ratio":0.308,"model":"constant_coefficient"},"devices":[],"climate":null,"section":null,"phases":[],"required_clearance_m":null,"design_wind_m_per_s":null},"analysis":{"loops":[1],"models":["hybrid"],"wind_speeds_m_per_s":[5.0],"closure":"exact","physics":null,"aerodynamic_model":null,"aerodynamic_load":"expanded","longitudinal_inertia":null,"stretching":null,"critical_wind_limit_m_per_s":30.0,"harmonics":5,"finite_element_loops":[1,2,3],"static_twist":null,"loop_competition":"neglected","device_effect":"neglected","amplitude_curves":"neglected","quasi_periodic":"lasting","check":"none","risk":null,"uncertainty":null}}','12998feddca8018304a328e685ef0d5d7b742cc7e14a128d7604d1cefea147ac',NULL,NULL,NULL,'local','01a22c61-9654-7036-bc4e-27b27186b823',NULL,NULL,NULL);
INSERT INTO "jobs" VALUES('01a22c6196907050850d7003c4dff370','2026-11-30 12:15:22.825771',NULL,NULL,'accepted',0.0,'',0,NULL,NULL,0,'2026-11-30 12:15:22.873400',NULL,NULL,NULL,NULL,'01a22c619681710fb3a2b8734bbf5de4','{"batch_id":"01a22c61-9681-710f-b3a2-b8734bbf5de4","part":1}','841af8cfa1c239b79469d205eb0b38cba31ed15da7418937a6e4b5bdedaf594f',NULL,3,NULL,'local','01a22c61-967e-7565-8b82-b4e0226867f0',NULL,NULL,NULL);
CREATE TABLE own_aerodynamics (
	id CHAR(32) NOT NULL, 
	created_at DATETIME NOT NULL, 
	owner VARCHAR(64) NOT NULL, 
	"key" VARCHAR(200) NOT NULL, 
	name TEXT NOT NULL, 
	document JSON NOT NULL, 
	CONSTRAINT pk_own_aerodynamics PRIMARY KEY (id)
);
CREATE TABLE own_conductors (
	id CHAR(32) NOT NULL, 
	created_at DATETIME NOT NULL, 
	owner VARCHAR(64) NOT NULL, 
	"key" VARCHAR(200) NOT NULL, 
	name TEXT NOT NULL, 
	figures JSON NOT NULL, 
	CONSTRAINT pk_own_conductors PRIMARY KEY (id)
);
CREATE TABLE results (
	job_id CHAR(32) NOT NULL, 
	point INTEGER NOT NULL, 
	axes JSON NOT NULL, 
	horizontal_tension_n DOUBLE, 
	catenary_parameter_m DOUBLE, 
	sag_m DOUBLE, 
	longitudinal_stiffness_n_per_m DOUBLE, 
	den_hartog_coefficient DOUBLE, 
	den_hartog_unstable BOOLEAN, 
	warnings JSON NOT NULL, 
	engine_version VARCHAR(64) NOT NULL, 
	failure TEXT, lowest_critical_wind_speed_m_per_s DOUBLE, largest_vertical_m DOUBLE, tables BLOB, orbits BLOB, twist_rad DOUBLE, batch_id CHAR(32), largest_height_m DOUBLE, largest_width_m DOUBLE, input_hash VARCHAR(64), verdict JSON, galloping_hours_a_year DOUBLE, 
	CONSTRAINT pk_results PRIMARY KEY (job_id, point), 
	CONSTRAINT fk_results_jobs FOREIGN KEY(job_id) REFERENCES jobs (id) ON DELETE CASCADE
);
INSERT INTO "results" VALUES('01a22c618660709a82c0a13c48c5b54d',0,'{}',30000.0,1.28545774507573264599e+03,1.5411767146887986879e+00,1.28460672233095508996e+05,-0.1667,1,'["The physics is the source''s, because ice.aerodynamics_at_rest is not given: it neglects how the horizontal velocity and the rotation of the sub-conductors change the wind; the longitudinal inertia of the hybrid model; the stretching of the conductors by large motion. Motion in two and more loops depends on it. Give ice.aerodynamics_at_rest, or a measured table in the place of ice.aerodynamics, for full physics, or ask for \"physics\": \"source\".","Eccentric ice would turn this line by more than 5 degrees from the angles and eccentricity that were given. They are taken as those of the line as it hangs; if they describe the untwisted line, set static_twist to solved."]','0.6.0',NULL,2.40001025986754124019e+00,1.30329933978514889147e-01,X'28B52FFD6098109530004A5A3C0F2240479B07C01CACBEA58B261E4CB5E63152CF518324404016D1762643D21B8BA2E86EF200E900E900D12E12CAA4F12A8AC5DA673FDE78106FB485018859DC19DFAD0FE7628C42824F22FCC4DD9728600C73D04B3078AF1014043F07130C855249F84909331208F7110258000A423A0E4141EB8120C020E6E1FC3BDF1AC3BC3444BB3CA918C45CBBD4EB1637CA6878065A1563245FDC5833C69CDB69477AAB4429DF80CE88A84FE11ECE57DF4B680C29978998E91E315F7593463BFF1A03316AE66E0D21E5A9F9F09DF440AC34610CD60E2FD59CFD1C8C1805BDCEE0BDE2E483F1D63F304653C9474A662CE0AEADB480314E27B59C3575B899391D0731D6D5579CC2DDB7931AC3D85F18C458854AF91006C100C45C1893FA0706418DD26A67C45AA33EF82C6FC75942A7DD1BF2731C23C1E1C3882D4F9CBC932F3EB8602EF713639846DA5CFBF5FD34066BDE07A9A61053E8B4831143E37DD52D0C82185B6302E79BD47E75F2CDFA77C6E411F50F26850631AFA0F02ED418CE8C35332FC59C35C6474F1A6DA5D71809F541A995F7E9F69450274F2CA1D46D35D42C1D8C980389580D8B844100E72F04BE1E8C5148602C62C6AA58C4D8BA504302117FD278E1C702D7C1781F62C604BC5FAFBDF025E2A741CC8BB7FE8C4EBE1993E546C4A432994F31F00631C9A332F9848DD2B0280631F213AA70302ADE5C24B4FE33867958176A8D8501A8B58318353A8B9BA5968E3B2F18131AEB2B2C93242AEA1F0E31710ECEA55EF99624DAAF932AEA4B2C0C2E990B3DDC08A9FC0303F8EE7DEE40DD4BC47CEEDA47D4278F4A4871737B776BCA93874BF2754645F2AAE3D48EE38851B8FB5CF207F5AD81BA6452F816318BAB58663448C0F9AA41C20574372AA27CB11AA28C0B81370A8C90A7C6123B7ECE3907AEFD9AD25A6DA5F6E4C7D939B8EB4B58379F629F62EBDFC373B6C6A7B8978677ED5C8CC150277550A7666F8698276584961AC4BCB2B8C630D6D20A937FC5C60ADFBE04CE529F8598AF56DC0EEB830B90520A31969AA7C44EAB741C84580A090AC917A052D283310AC92BBECE573C7C52B9F00F87770FE3C1270636566314E2FD828DF5290A0A9D5138A80B749F2C374A45F18C514870BAE015776ADEDA5207EB82F7C5B8A9D578793BAC1DC81C149A60A42E8768B0058654622731D4B82DE688990F6E05BF523ADE870F3A6B29D48EF62E78D62AA57496EAD58DB51FED0E0A4D9876C4CECDBB1D6FACF1C108216EE8B0C394F742DD071FC6D262C6987743EDCEDCDAF1E3ACADD4A839B9628B4F43AD1DAC962FE5EEE830C68E94331FAC781D941AF751AE12F3E327A575586A8955637CF051CEAC546BEE072DE66EA9155B0D0580E5A8B11142049111111111199AA485032042A210A2323B124803258C922093C61864A4440289244890A48C24E73F96B0693046FE65CE89637430B6EC049E7EB340014B346F26BF325268C8A6B36B2A25396592FE58F622844D6A07E44C040C25647877323441976D1AFAF199C06CA432C231570C5397F658BB651D714DFD9735B63536D1BC89DF7BA02DD4FF76AF7DE776CE04AD7752E01BAA5517FF78FC5C93C15D609589285C01E31518A2A4CD3DE4FE530EC4B990F10AAC887B368250F6547A175D580CE58CD554A24D2520F2CD1035444539BAC841A092E62D4F30EB6E185037A856DEBA7ED219DE6774B5F2081E8AF908B3CF0BC1B8258F881918A4278661C2C2CAE5C7C74D9C12F5DA009466A66641DBF7D724E3C049F5FA10DDA1998FFB515B2FD86FE25107854592ABABA4E5133EF447F1C66C907429BCD83EE022FB645BB29EE9144C2C11BC3E33883D40D8E48C924871E899871021ADEF2CDCED4BEBB8DDDB6634A3AF4F0315EB03402EF9093BF6A9A1F5186EDBC2BFF649274736C016F02BEDBF441B4C10A0D631C0AC7B17353432C8FD8176D5211543B858227E6CB5BF2B772D5AB7C3CA1EA4E342A7284A40D5C54AD59CDA10728E2642963C5B6F400365418E23C2032375E6CD217F91A323C401EA4C9F67BDA2FC046816A67988B212995D6D42BC6B4865D03D79F155515D04AB28EE5251104E54ABB43E809B6650070E175223A501BFF211F2FF42813E92499A45E23D526EDED92DE9B1448C256F3713D02921E16BD5EE55346B4C958269F5E5BB64F255AE2CCB2AA82A',X'28B52FFD6015029D0D00C6E85B1B704BD206C01C571C90AA82824015A1B2BB376D9A14E1D2FF7F3101580054005300460ABA639DED67EFED65C8305218964C556B3D4F554C06967CBBC9534E2DADC88868F41ED23FF4B21C97094DA5291D75EE783EF57A1A76D4F5DA2C2B916FE9B6A524002071304060C0A0503424C600248A03020782044440F553D9673C5644FFCB86B6938CF0F53A9A3A53DA58B5A5A39E739FF9D1B9450684840703858482C410405210E69CD9C6757D2C430692E2E6B0D06AEE3AAD8BABC659839993996D21328E14676B51D91915DF322386C53BA7D1E67CCF4CC7C19A194282C18242024362082429DC34CABCF9CEB0AACC4852B84E35E3CB63F49203496183542ABDBD735E2A4BE772ED923AA5A6728E636367B58A113D747375BFA78B07E14BF92C07021102468ACF4DA5155DD50D8B49EDC169A933D3D2E96CAB22BDD8A87ECA6AE9B271715A4F2A9B2BE18DB906D2FD473E390BF38A5694897DA18F9D214A538D65871FEBB3EEFE335675614B07B50D1700464428B5ACF28059C00D7206B84203AA42470650AB8A00C128FB64CDB9E501B58146A2391C8BFBA7ACD156BD863F6603CE611D9C3ADBC9F3013AF5082C36F7',NULL,NULL,2.6065954169239680116e-01,2.01438115050101076985e-02,'b5b41c6cd092271167f58b03866faedf30eeafb85ebc8291bcd00248eac4256a','{"gallops":"yes","onset_m_per_s":2.4000102598675412,"worst_wind_m_per_s":4.0,"worst_loops":1,"vertical_peak_to_peak_m":0.2606598679570298,"horizontal_peak_to_peak_m":0.020146533991001303,"tension_range_n":null,"clearance_m":null,"clearance_margin_m":null,"clearance_ok":null,"ellipse_peak_to_peak_m":4.929068881890764,"probability_gallops":null,"trust":"plausible","sentence":"Gallops from 2.4 m/s; at 4 m/s in one loop, 0.26 m peak to peak.","what_decides":null}',NULL);
INSERT INTO "results" VALUES('01a22c618d6677199255854b42ad9839',1,'{"number":1}',28000.0,1.19976056207068381809e+03,1.65130957497197661254e+00,1.16879478978556478974e+05,-0.1667,1,'["The physics is the source''s, because ice.aerodynamics_at_rest is not given: it neglects how the horizontal velocity and the rotation of the sub-conductors change the wind; the longitudinal inertia of the hybrid model; the stretching of the conductors by large motion; that sub-conductors move along the span by themselves. Motion in two and more loops depends on it. Give ice.aerodynamics_at_rest, or a measured table in the place of ice.aerodynamics, for full physics, or ask for \"physics\": \"source\"."]','0.6.0',NULL,2.34518708662499841821e+00,2.98492320651015163868e-01,X'28B52FFD60FD15B536005A65DC102360479A07302686E65AD177FF3C8910C6B65B01152508EDDC0C696A99C3AE230641601E1501030101014A121D63E0CF71122795E413142A868639C7513E910BF2E0E2624222E7BB539C7FB391F4D00769428289125666692875F4618508B0426A30E03809354257E7BFD89CC220C127F07D82549728708A63C85A3870CF1496C2BAB185829152297C9485080B14C052F04275850014C05268031516390F0501E738FFE2D7F8F414E71503A48D5398739C4A9B5991840A156870063999A70C54943F901122A65B907FD14DF7CA3B85A234F13811794474138912D2F8F514CC685B6266BB6B2D525BA33C00A74C9CA2B7176D73F2C49A3765EC7116599103F70CA2B807EB7C8453B054D6F024C20248A55316384562AD25E4CE763156A90D741C8ACC679005A94FA33CC5A19F708E4319A9280E71100C384E7D30998F701004A7E8B44CB56D0CF136D63C1DC7290A7C549EE33C93504F712895F325FF0C85F33D75095A6ADC6CA9D4BD14426A1929D4CC5A6B76462D19CCBCCB193796BA21B6D0D12CB5C6C87D35A510F336B848805477B3522BA9D5DB6C8D2D884DFDE414870F3E95FE741F4FA1DC9DA5845442DE9C9BB1C791B0BA89249CE33874C2E4451725FD89282ECEAF11268F988F10E53BC7F945BEDAC853ACEED54B31C61C35943C4A48A7ACA7408AD957B56ACEB6BDB5AFD58A175B8C354FC61EE740621A121207C18BDF10F879388541824311114E861E87CE461A1208F8F11427810838CF71A284F53D2C509107AB43449878F567A5F5BD82F8788EE3609D1F21A2B80893A642449401A8DB0D56C881918983D23253DD8E96375A89D92EB36AB65862C4C67AC1776BAC11530D2D42A919AADB6AAB5B6A94525ADDEE2B25C5DED8BD35631763ADA9E4A92D867AA95D63D1A245482D6F6A2D6A6DEDB673EA76969ADAC6BBC6F226B5482DA6967B6ADB9C394A492584583B2F67BC8C3553ACB1071309E733AB24095CE61F0E304190179B5915D72490FE8C72992E91604092D8C843854F2A8F70F05CAD0E3948E415447448A58F984E51CBD76A8B7917B72F4FFE35C9CF0897C44D645333901F6741AA439247984F0D1249A27C4F8FB334111E245E74D3708A3592F2121E52E1021507A7012AB021F0D32528121D431D43E7D78343E8848E415E31B84A6313090C922F2015451E4E6190FCF233FEF2CF294C7D7F383CF20F227C7240E13C8501AC6F40E174CC221F521820CCE6219F34152ACCE24E61900071C173A36D9D9657AB6664A0736064628FD91CA0811AB87B4ADB2A2DDEA6522F177C6A69553763C654A7DD46AC90B3C698314EBE6B999B23DF66885773B72F57BD922FD57CB9BB999942C65AC6DA17EBD5D6BAF2B56B2CAB6D2B3172F76ED49D94FB7AF2D6CC9762861853BEBBDAFA5AC6CC57776AC4505B89B552CB2A2DB56915EB75C48A97952F6AD4126B28AD6A8E98F1326F56EECD57E265576C79BB11438877778D652E78D5CC1AB594D8528B9B1BEC5CF04B31DF4D6AF10A8112A81192316464444444444853C870518484E49882DE7A124000B9284AB220478D2186488D04128804224192149424CB017A4A380C2000D5B07A6AE3D01EACCC86CA0EEA1C18E5A65AEE497D455AF8C167CD9F3AA7A894C2867AF2B76523CF0A9C5F174C72DAD8F3BAA3A1EAA656612CAA27438A544B4BA76327A9C7D5DB39B447DCE779847AC611EAC94FC36CFC11EF675FCB95C48C80011367520320B1A329400FA07A5EB9B119A2250F01664DF2A0042CFA030D9003F6CFD3EFD2507539AA2A46665621C358DD08D82A824F7BCFCC56B541F10A6B425125AD9C106B3D960ED713B6777FFC8C96BA7105B33671200B784BB0C29D5C9BFE03A5ED9D9EFBED7752FCE6E858AFC33F8E13136B32DCEB57395A554C5D3431C2ABBA35EFB018C22CAACA4050DB17B166AB16EDA53240C7770B2BE1BE8FE2F76CC7C8FB66880706282307B03095B16F9983198FC5AA1CC032CDC12A94BDB322D0534993F13146DBB61AD4433821BC5F6C7E1BEF39B0B1EF332CFB25797AFD11D1B4885B78C067247D003C72C67BA61D79A4CC4B1768AE773FA9DDCAC2BBAD6522066B4F58283E2C00A7922501BFAA0282941B0CC612D9A2E0DE03E6DC72DA16F6AC4E8DEC8C1C532243B7974D9DA6C204039B172439BDE0DF6D7019D31E830DA33818614502A2139544A4F953205DB20B0705A0D5CC4AAB96DE97B034A709D283CB1D1F37DB2CEC9E8772EB01D7C10CB16BD5242C67797227ECA5E6633C2B16AE6B8186EC93DE0F8A9C79A15F698B3087F20DCA3AC818EF3C71619E9E34947AA7B17D81B97861804FBA137FBE6959A92CFC9F2C1EF8971481AF021FC1DC9C9959F84F7528D755A0563CBC971A910AD0991F863DAE06D43979A525CBF81FCDE3F3335E45ECBBB2F619C3F21391CF37185A04BC4CB8BAD4A48E194D54E0CFBD2CD95B05',X'28B52FFD603905FD18008A4D140A1B604B923658E7D91E2AB35C330802A4BB376DDA3431B27283205822AA0097008F007734359F92C80E759B19573EF759CDB7D89C7E2A230304091E185090A040C22080220A7215FBC2DF7C322C068A2898CAA4629FB764A2601A2F32C72B991F228613850EE932AFF31031942890ED8EE4A1A3B71E23868B82A97736A1D96A373C5C144EC64AAE3E559E316238FB6BD35BD10D2BC3FD9C2211696D2E83C345A1588BA5ED99DC1C1503F9E64267328D7C480E8A0000120E0C2060808182428384410024140E1070402001428052376F4DF3E1A22A52B5475637394E4FF8AA4E69A3446B8EA86347B5BA21767424DFAEE82692A10CF98AAC352C865EEE73732742D7841C1CCAB912D2A5EC6432D369A757914C86214860608182040C12060122A2E0AAA16D789BDF8689414414AC45D363435379B46AFC19A3EB4DE8434A3D5EF1C8266679D5A48E5CAF13E74A44D5BA22B91C52FF8745ED9D1F2686939EF87DFB4EF9376433480CE27B9953472FAB2866B3BC74E7C78A68F3CF48DFF2E5E02057B7A5EE22F37AA2F0A95C2B27FE8C3CC6A5D355421FEBCAE4AEB279A975A957CDD5CACB431B72E58DD0E6DE77540C36BC58716EE9EF8476AB1FEBB1A1DE7868343354A2B11BBA5745339367BB0E0E35ADEC7BFD8A63C2E3EF664E9FA99FC80C11484C34E65C9DEE87F48CAA48C8DE3BC3E40D0222083851F0DCB974DB437C6296AEA88CAD712FFAF5754736261E3364135A4CACF1E3C4D14C452EFC95668C0991846EA306392ADBBC780F9190F749C923EE982424B2A1DC366253624356B6E8CE779A71EB88689AEF95D5E1CFBFD094D51E2506D6C8895BBFB2194372B688915D2775C83D45C67BF54573C850A2E0BB7D5A8726EC68A96ACEEC88A8C7E1C144C14262DECC303720308284CCE90D7748E0308B0B18D4ECA809908F23527E6E9CB6C26E699658B9E61D72008F48908395A0810EE8B8D9672904E3BA9B9A01439E2041F6370CAD32DA010AED2C7112935373655CB6275C52E23280171955D8026E48B001D00FA0010CE4EC301410BD2AEF19D8E6428C6D194281407C83AD07F81C95C269F5A2466E0E8C19EBEE0D8C89A583389898F65ABA986CB85E14',NULL,'01a22c618d60718ea1c1abd65411f6ad',5.98784181345673127694e-01,5.23064091073387249508e-01,'a39ea94fe8a2e2a60e30b30f49bc56826367324d1f6ca005e046ac4a3a7cf37b','{"gallops":"yes","onset_m_per_s":2.3451870866249984,"worst_wind_m_per_s":6.0,"worst_loops":1,"vertical_peak_to_peak_m":0.5969846413020303,"horizontal_peak_to_peak_m":0.05207700811490211,"tension_range_n":null,"clearance_m":null,"clearance_margin_m":null,"clearance_ok":null,"ellipse_peak_to_peak_m":null,"probability_gallops":null,"trust":"plausible","sentence":"Gallops from 2.3 m/s; at 6 m/s in one loop, 0.60 m peak to peak.","what_decides":null}',NULL);
INSERT INTO "results" VALUES('01a22c618d6677199255854b42ad9839',2,'{"number":2}',28007.0,1.20006050221120153767e+03,1.65089666152918,1.16921742154243474937e+05,-0.1667,1,'["The physics is the source''s, because ice.aerodynamics_at_rest is not given: it neglects how the horizontal velocity and the rotation of the sub-conductors change the wind; the longitudinal inertia of the hybrid model; the stretching of the conductors by large motion; that sub-conductors move along the span by themselves. Motion in two and more loops depends on it. Give ice.aerodynamics_at_rest, or a measured table in the place of ice.aerodynamics, for full physics, or ask for \"physics\": \"source\"."]','0.6.0',NULL,2.34539254971640165337e+00,0.298455958775587,X'28B52FFD60F7155D3500CA65F0102360479A07302686E65AD177FF3C8910C6B65B01152508ED1C595ADA99C3AE230641601E1601030101015249A2630CFC394EE2A4927C8242C5D030E738CA2772411E5C5C4C48E47C778AF36F36921EFA204D483051C2CA2C0DA58E3EAC100156480D061C27A146E8EAFC179B531824F804BE4F90EA12054E710C590B07EE99C25258656CA160A4540A1F6521C20205B01454A1BA42000A6029B4810A8B9C878280739C7FF16B7C7A8AF38A01D2C629CC394EA5CDAC4842850A3438839CCC53062ACA1FC80811D32DC8BFE8A67BE59D42519A789C883C22BA89440969FC7A0AD57A39A36E8B96628B7C6B9407E0948953A4C5ECBEB83137D5DCD8E32CB22207EE1944710FD6F908A760A9ACA192080B20954E59E0148B37295E2D396AEDA90D741C8ACC679005A94FA33CC5A19F708E4319A9280E71100C384E7D30998F70100448B595BCDB2AEED6D4719CA2C047E539CE3309F5148752395FF2CF5038DF5397402DD50C25D6986ADFE4EB69792357A97163DC92C18AA594126B56BEAA2D743443DD8DDA726EBE4CB5C14582A4D83D31C69CF56EB335B6E038880863533F39C5E1834FA53FDDC753249692337362D59AE266EC7124AC6E2209E7380E9D3079D145497F228A8BF36B84C923E62344F9CE717E91AF36F214A8195AEBECCC8DA1A4A28474CA7A0A675FCCADEDA6466D5BB596124BEBDD506B2A197B9C03896948481C042F7E43E0E7E11406090E454438197A1C3A1B694820E0C7539C0422E03CC78912D6F7B040451EAC0E1161E2D59F95D6F70AE2E3398E83757E8488E2224C9A0A1131DEAD94D18E1C189938ED8BA5E5F5C41842885B2D5E4DAD5E9618B1B1AAE0D9A6A51A6BCAD1AED40C6FD498A5C4082196D4EA6E67C8D72E5FAC546BC6F22AE6E6DC8BB1F7F25D635363A41AF162D41A52DE49B5D50BB5DAC6BBC6AA86D876735EC4546A8B5A6B67C668B5D58A9DD16AD4DEBAB91F4C249CCFAC922470997F38C004415E6C66555C9340FA33CA65BA4482014962230F153EA93CC2C173B53AE420915710D121953E623A0521A652B7526839524B25FF9AE467844BE226B2A919481D6741AA439247984F0D1249A27C4F8FB334111E245E74D3708A3592F2121E52E1021507A7012AB021F0D32528121D431D43E7D78343E8848E415E31B84A63738A090C922F2015451E4E6190FCF233FEF2CF294C7D7F383CF20F227C7240E13C8501AC6F40E174CC221F521820CCE6219F34152ACCE24E6190A0B9E05972D55A31D428F926A3CF8191893D667380066AB0962B476BA565C62AF572C1A7D4AB1C2D847A53DA65CB92B32FEBD6CADB58AE363147BD923373D4CB182FE4BD126AB4CE5C39234E0A192B356E9D1A27C56B955ABBC6726ABCA81B75E2DE5D691143BE96B35AABF1BA3B27B696B12FC4EE6CDD194BAC59536CAD526955775A8516735F8B79734FACA1D4DA2AB5EB0DA96EB468BD35E6AC132FABC4D632376A891B42BCBB6B2C73C17BABD6BCDC57737353062F2E78DF8558AD2FB60180F5A8B19141C49019111111A999A485033042A2104D957912403091288AA21C291121C698120924926024882465A69503791F5830F82F4F9E271F468F63ACDE59D1F06611B24D9EB62B2E8A72F5BEF3CC4FCE260AD6B42D143D95DAE4A133F5E1172F681C95615E5434E8116A399B22E114A1907289F45677A484488F67D472A4BEB3630E9E6BA2FBCDDDED51CF450A32C958B338A870D7CB9E4F0092782A92DEB3BF956C41BD336E16D042E7D076B061134A08802607874C4DEB47CEEEA3577B004E0D9261F1DF0C588BDADF7E92BE30D7DB682F06DDFA7774228455E16A628DCCEC1D0779C93AC317E873879A7E3BB0A1F0226323153581D6EC5CC8E7B4712986A8D8418CB994CC96623DE49B8A642783B2E440C1572567B46485497A05F2724CC4D404564259C62B40BD951419A7D9C809548367E8D508C794273F1AEE01185CEFC7561624E9E2F50544B96B0E0A4B6C96346380BB7754E60E8927A209C80265B5E0A376BB67445CC3F2676194670CD48C0AA0AD6313838F358112A50133ADA477E1B27D007E6E7B1B6D1DC5A6BAC6BF397222379E9781B9B210E60E6D5A78B2F4D43FE0E182DED60F9BF865B04405043967950F4599D7FCF823C1D09C3002CD9C5DB51C54C2C209C9417088B9AA63009F6DBD574D6E98C1756486E6003C12746865C953B19226648256025C18842EE9B31E872FE72374AD3BD801A40AA41DCD18A73C42CEA13E94E6400328CD5B23431BA000D1AEAD625B025408CDAB408AE7570447B459E7F02D40D17AB4FB012814230F734D9686FBF4079EEF1603F486C4DCA41CEF38736368662944B8930B1FEF10884E88DBB5ABEEC29815A71ADFD31967EA3DF3D5CB2A842A',X'28B52FFD602F05AD18007A4CF4091B604B923658E7D91E2AB35C330802A4375776EF943C59B941102C11AA0095008C0057F709916AEED29AD1676484EC648020C103030A1214481804B0A23053FE4E382DF2758C18585130332A9B595F529A51315C14CA6C7E09F568C21A15C38942F53C64356442BB1915838982F52F8FA45B3D43C450A240443E912F13FB1B3394289490AFF47EC9468688E1552C0BEBEC48E80E532BBB90BDCEA43A389428DCC64A77EDCB86C362B80CC9F7A8C62D2139280200483830808001060A0A0D12860248281C20E08040028400014657532275C9D16B3EDD3A6367C37A23D6F0526276A31E31CD9ABB660CAB756717D96C63C4F093AA49A6E5F16B96478E5ED61AA24E89D94AF38E234860608182040C120601AD2810BDCAC86845AD8F8BA1150513331313D2F5C466782E9513FA1DA9467DD388EFACAE36756DB1D7EE45345689D22153C71C1D2E0ABF8A89329C9EC6C5F0F3B49DA64E6431ADD6BB6BC81F911E8E1262384B4F7E2C96661CBA9253D69CDB14A53EAF31B36CA75B6AA609CF76A4C9115519CD90FBC91B8D8FB4AB729D342FFBAA0ACD0CBDBEBA333F2A861285F9143F9CCAB83C2C0657A6ECB9B9A2BB92D51AA153C8867C25ED4733E4B9FC131675AA577B09CDCF8383CF93495B6279D9298F5DD1D4B53244B8626F3A8DE21A358BE698DFD332DEBBC97767596A4C022208385198B3F5A4FDC646A1DA781FA1A2DAB89A1392EF3C569D21F6D68835CEF30FED6829C910A1B196B329717DD8F0D7716C6A2313951CE291CCC93687F4F9DDBDA67E2FD2E187A713C98CCC904325A4F84CF39950D5F59633C3C42033250FBDA7BA0C11BFA295CA4AF2E84C5DED68FA094707138557AEEA6C6CD3C327F6D35DA21EC70C1785A9947DF76A5D3C2835202082428CF27C8E58EBC277156C8A082FE1C02C2AE87BA26DD911D6CB09A0FD04361D6C2232A8803010209B8D15575EC320E7411ABB9ED4DE550DFEAA8BFEE255035314159019F040797F3AC02604F8D1251744A6F88B91C20EB8ABC0B10CD459B8CB022AF5ED2E4E70AA8A97DCDF28ADB1DA9A7A08DD16A2067403069DA1B4A16678E7A5C6B38671ABA4819E828860C255CE',NULL,'01a22c618d60718ea1c1abd65411f6ad',5.98711849306213350629e-01,5.23073813456266800692e-01,'ceb022c150d67fe3f5996f100c9976de6397ba9956b3ce4685ffea03c63412a4','{"gallops":"yes","onset_m_per_s":2.3453925497164017,"worst_wind_m_per_s":6.0,"worst_loops":1,"vertical_peak_to_peak_m":0.596911917551174,"horizontal_peak_to_peak_m":0.052086720932157396,"tension_range_n":null,"clearance_m":null,"clearance_margin_m":null,"clearance_ok":null,"ellipse_peak_to_peak_m":null,"probability_gallops":null,"trust":"plausible","sentence":"Gallops from 2.3 m/s; at 6 m/s in one loop, 0.60 m peak to peak.","what_decides":null}',NULL);
CREATE TABLE tallies (
	id INTEGER NOT NULL, 
	name VARCHAR(32) NOT NULL, 
	label VARCHAR(64) NOT NULL, 
	count BIGINT NOT NULL, 
	seconds DOUBLE NOT NULL, 
	CONSTRAINT pk_tallies PRIMARY KEY (id)
);
INSERT INTO "tallies" VALUES(1,'jobs','successful',1,0.179259);
INSERT INTO "tallies" VALUES(2,'chunks','successful',1,0.064006);
CREATE TABLE webhook_deliveries (
	id CHAR(32) NOT NULL, 
	owner VARCHAR(64) NOT NULL, 
	job_id CHAR(32), 
	batch_id CHAR(32), 
	url TEXT NOT NULL, 
	receiver TEXT NOT NULL, 
	created_at DATETIME NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	payload TEXT, 
	attempts INTEGER NOT NULL, 
	next_attempt_at DATETIME, 
	log JSON NOT NULL, 
	CONSTRAINT pk_webhook_deliveries PRIMARY KEY (id), 
	CONSTRAINT ck_webhook_deliveries_job_or_batch CHECK ((job_id IS NULL) <> (batch_id IS NULL)), 
	CONSTRAINT fk_webhook_deliveries_jobs FOREIGN KEY(job_id) REFERENCES jobs (id) ON DELETE CASCADE, 
	CONSTRAINT fk_webhook_deliveries_batches FOREIGN KEY(batch_id) REFERENCES batches (id) ON DELETE CASCADE
);
CREATE TABLE workers (
	name TEXT NOT NULL, 
	started_at DATETIME NOT NULL, 
	seen_at DATETIME NOT NULL, 
	processes INTEGER NOT NULL, 
	version VARCHAR(64) NOT NULL, 
	CONSTRAINT pk_workers PRIMARY KEY (name)
);
INSERT INTO "workers" VALUES('host:456:1c19c560','2026-11-30 12:15:12.816452','2026-11-30 12:15:21.428734',1,'0.6.0');
CREATE INDEX ix_jobs_status_dispatched_at ON jobs (status, dispatched_at);
CREATE INDEX ix_jobs_status_lease_expires_at ON jobs (status, lease_expires_at);
CREATE INDEX ix_jobs_batch_id_created_at ON jobs (batch_id, created_at);
CREATE INDEX ix_job_tags_key_value_job_id ON job_tags ("key", value, job_id);
CREATE INDEX ix_job_events_job_id_id ON job_events (job_id, id);
CREATE INDEX ix_batch_items_chunk_id ON batch_items (chunk_id);
CREATE INDEX ix_jobs_owner_created_at_id ON jobs (owner, created_at, id);
CREATE INDEX ix_batches_owner_created_at_id ON batches (owner, created_at, id);
CREATE INDEX ix_jobs_owner_asset_id_created_at ON jobs (owner, asset_id, created_at);
CREATE INDEX ix_results_batch_id_lowest_critical_wind_speed_m_per_s_point ON results (batch_id, lowest_critical_wind_speed_m_per_s, point);
CREATE INDEX ix_results_batch_id_largest_vertical_m_point ON results (batch_id, largest_vertical_m, point);
CREATE INDEX ix_results_batch_id_largest_height_m_point ON results (batch_id, largest_height_m, point);
CREATE INDEX ix_results_batch_id_largest_width_m_point ON results (batch_id, largest_width_m, point);
CREATE INDEX ix_idempotency_keys_expires_at ON idempotency_keys (expires_at);
CREATE INDEX ix_jobs_owner_input_hash ON jobs (owner, input_hash);
CREATE INDEX ix_webhook_deliveries_state_next_attempt_at ON webhook_deliveries (state, next_attempt_at);
CREATE INDEX ix_webhook_deliveries_job_id ON webhook_deliveries (job_id);
CREATE INDEX ix_webhook_deliveries_batch_id ON webhook_deliveries (batch_id);
CREATE INDEX ix_results_input_hash ON results (input_hash);
CREATE UNIQUE INDEX ix_own_conductors_owner_key ON own_conductors (owner, "key");
CREATE UNIQUE INDEX ix_own_aerodynamics_owner_key ON own_aerodynamics (owner, "key");
CREATE INDEX ix_results_batch_id_galloping_hours_a_year_point ON results (batch_id, galloping_hours_a_year, point);
COMMIT;
