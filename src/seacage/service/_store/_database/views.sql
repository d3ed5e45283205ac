-- Views for other programs, in the words of either database: those in braces differ.
-- t_us is the time in microseconds since 1970 UTC, by which the tables are ordered.

-- Usable readings of each sample; those that failed a check are NULL, and remarks say why.
CREATE VIEW readings AS
SELECT cage, stream, {utc} AS t_utc, t AS t_us, remarks,
    {reading[current_speed_m_s]} AS current_speed_m_s,
    {reading[current_to_deg]} AS current_to_deg,
    {reading[hs_m]} AS hs_m,
    {reading[tp_s]} AS tp_s,
    {reading[wave_from_deg]} AS wave_from_deg,
    {reading[depth_m]} AS depth_m,
    {reading[tension_kn]} AS tension_kn
FROM {samples};

-- Means of usable readings over ten minutes, from the service's aggregates.
CREATE VIEW readings_10min AS
SELECT cage, stream, {utc} AS t_utc, t AS t_us,
    max(CASE quantity WHEN 'current_speed_m_s' THEN mean END) AS current_speed_m_s,
    max(CASE quantity WHEN 'current_east_m_s' THEN mean END) AS current_east_m_s,
    max(CASE quantity WHEN 'current_north_m_s' THEN mean END) AS current_north_m_s,
    max(CASE quantity WHEN 'hs_m' THEN mean END) AS hs_m,
    max(CASE quantity WHEN 'tp_s' THEN mean END) AS tp_s,
    max(CASE quantity WHEN 'depth_m' THEN mean END) AS depth_m,
    max(CASE quantity WHEN 'tension_kn' THEN mean END) AS tension_kn
FROM aggregate WHERE width = 600 GROUP BY cage, stream, t;

-- Alarms as they stand.
CREATE VIEW alarms AS
SELECT cage, item.key AS alarm, CAST({alarm[active]} AS BOOLEAN) AS active,
    CAST({alarm[acknowledged]} AS BOOLEAN) AS acknowledged, {moment[since]} AS since_utc,
    CAST({alarm[value]} AS DOUBLE PRECISION) AS value, {moment[shelved_until]} AS shelved_until_utc,
    CAST({alarm[in_service]} AS BOOLEAN) AS in_service, {alarm[comment]} AS comment
FROM alarm_book, {alarms};

CREATE VIEW alarm_journal AS
SELECT number, cage, {utc} AS t_utc, t AS t_us, {line[alarm]} AS alarm, {line[action]} AS action,
    CAST({line[value]} AS DOUBLE PRECISION) AS value, {line[who]} AS who, {line[why]} AS why
FROM journal;

-- Share of each line's life that a stretch of time used up, and its minutes with an answer.
CREATE VIEW line_damage AS
SELECT cage, {utc} AS t_utc, t AS t_us, item.key AS line,
    CAST(item.value AS DOUBLE PRECISION) AS damage, CAST({sums[1]} AS INTEGER) AS valid_min,
    CAST({sums[2]} AS INTEGER) AS missing_min
FROM damage, {lines};
